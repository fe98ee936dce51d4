//! What is known of a finished variant, kept in a file of its own.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Map, Value as Json, json};
use tessgraph_geometry::digest::Digest;
use tessgraph_graph::world::read_plain;

use crate::json::{number, pretty};

/// The name of a record in its variant's folder.
const NAME: &str = "variant.json";

/// A record is some kilobytes; more than this is none.
const LARGEST: u64 = 16 << 20;

/// A finished variant.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Record {
    /// Digest of what was asked for.
    pub(super) job: String,
    /// Digests of all files that mattered, by path from the graph's folder;
    /// `None` for files that were looked for in vain.
    pub(super) files: BTreeMap<String, Option<String>>,
    /// Why it failed, if it did.
    pub(super) error: Option<String>,
    /// The measures in the order of the study; null where one is not known.
    pub(super) measures: Vec<Json>,
    /// The files that were written.
    pub(super) kept: Vec<Kept>,
    /// Milliseconds it took.
    pub(super) ms: f64,
    /// How many nodes were computed.
    pub(super) computed: usize,
}

/// A file of a variant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Kept {
    /// Its path in the variant's folder.
    pub(super) path: String,
    pub(super) digest: String,
}

impl Record {
    /// The record in a variant's folder; `None` if there is none, or it is no
    /// whole one.
    pub(super) fn read(folder: &Path) -> Option<Self> {
        let bytes = read_plain(&folder.join(NAME), LARGEST).ok()?;
        Self::from_json(&serde_json::from_slice(&bytes).ok()?)
    }

    /// Writes the record into its variant's folder, as a whole or not at all.
    ///
    /// # Errors
    /// When that cannot be written to.
    pub(super) fn write(&self, folder: &Path) -> std::io::Result<()> {
        let text = pretty(&self.to_json());
        crate::atomic::write_if_changed(&folder.join(NAME), text.as_bytes()).map(|_| ())
    }

    /// Whether the files that the variant left are there as it left them.
    pub(super) fn is_whole(&self, folder: &Path) -> bool {
        self.kept.iter().all(|kept| {
            Kept::of(folder, &kept.path).is_some_and(|found| found.digest == kept.digest)
        })
    }

    fn to_json(&self) -> Json {
        let text = |text: &Option<String>| text.as_ref().map_or(Json::Null, |text| json!(text));
        let files = self.files.iter();
        let files: Map<_, _> = files
            .map(|(path, digest)| (path.clone(), text(digest)))
            .collect();
        let kept = self.kept.iter();
        let kept: Vec<Json> = kept
            .map(|kept| json!({ "path": kept.path, "digest": kept.digest }))
            .collect();
        json!({
            "job": self.job,
            "files": files,
            "error": text(&self.error),
            "measures": self.measures,
            "kept": kept,
            "ms": number(self.ms),
            "computed": self.computed,
        })
    }

    fn from_json(json: &Json) -> Option<Self> {
        let text = |json: &Json| json.as_str().map(str::to_owned);
        let optional = |json: &Json| match json {
            Json::Null => Some(None),
            json => text(json).map(Some),
        };
        let files = json["files"].as_object()?.iter();
        let files: Option<_> = files
            .map(|(path, digest)| Some((path.clone(), optional(digest)?)))
            .collect();
        let kept = json["kept"].as_array()?.iter();
        let kept: Option<_> = kept
            .map(|kept| {
                Some(Kept {
                    path: text(&kept["path"])?,
                    digest: text(&kept["digest"])?,
                })
            })
            .collect();
        Some(Self {
            job: text(&json["job"])?,
            files: files?,
            error: optional(&json["error"])?,
            measures: json["measures"].as_array()?.clone(),
            kept: kept?,
            ms: json["ms"].as_f64()?,
            computed: usize::try_from(json["computed"].as_u64()?).ok()?,
        })
    }
}

impl Kept {
    /// A file as it is in the folder.
    pub(super) fn of(folder: &Path, path: &str) -> Option<Self> {
        let bytes = read_plain(&folder.join(path), u64::MAX).ok()?;
        Some(Self {
            path: path.to_owned(),
            digest: Digest::of(&bytes).to_string(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_come_back_and_damage_is_noticed() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.csv"), "1,2\n").unwrap();
        let record = Record {
            job: "j".to_owned(),
            files: [
                ("g.ron".to_owned(), Some("d".to_owned())),
                ("x.mtl".to_owned(), None),
            ]
            .into(),
            error: Some("no \"good\"\n".to_owned()),
            measures: vec![json!(0.1 + 0.2), json!(true), Json::Null],
            kept: Kept::of(folder.path(), "a.csv").into_iter().collect(),
            ms: 1.5,
            computed: 3,
        };
        record.write(folder.path()).unwrap();
        assert_eq!(Record::read(folder.path()), Some(record.clone()));
        assert!(record.is_whole(folder.path()));
        std::fs::write(folder.path().join("a.csv"), "1,3\n").unwrap();
        assert!(!record.is_whole(folder.path()));
        std::fs::write(folder.path().join(NAME), "{\"job\":").unwrap();
        assert_eq!(Record::read(folder.path()), None);
    }
}
