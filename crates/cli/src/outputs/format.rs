//! Which file formats hold which kinds of value.

use tessgraph_graph::value::Kind;
use tessgraph_io::Format;

/// A format that outputs are written in, chosen by the extension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FileFormat {
    /// A mesh, through `tessgraph_io`.
    Mesh(Format),
    /// A picture of a mesh.
    Png,
    /// Numbers and texts as JSON.
    Json,
    /// Rows of numbers and texts.
    Csv,
}

impl FileFormat {
    /// The format that the path's extension names, in any case of letters.
    pub(crate) fn of_path(path: &str) -> Option<Self> {
        let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
        let (stem, extension) = name.rsplit_once('.')?;
        match extension.to_ascii_lowercase().as_str() {
            _ if stem.is_empty() => None,
            "png" => Some(Self::Png),
            "json" => Some(Self::Json),
            "csv" => Some(Self::Csv),
            _ => Format::from_name(name)
                .filter(|format| format.is_writable())
                .map(Self::Mesh),
        }
    }

    /// Its name in records of what was written.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Mesh(Format::Glb | Format::Gltf) => "glb",
            Self::Mesh(Format::Obj) => "obj",
            Self::Mesh(Format::Stl) => "stl",
            Self::Mesh(Format::Ply) => "ply",
            Self::Png => "png",
            Self::Json => "json",
            Self::Csv => "csv",
        }
    }

    /// Raised whenever the same value is written as other bytes, so that files
    /// of the version before are written again.
    pub(crate) fn version(self) -> u32 {
        match self {
            Self::Mesh(Format::Glb | Format::Gltf) => 1,
            Self::Mesh(Format::Obj) => 1,
            Self::Mesh(Format::Stl) => 1,
            Self::Mesh(Format::Ply) => 1,
            Self::Png => 1,
            Self::Json => 1,
            Self::Csv => 1,
        }
    }

    /// Whether a value of this kind can be written.
    pub(crate) fn holds(self, kind: Kind) -> bool {
        match (self, kind) {
            (Self::Mesh(_) | Self::Png, Kind::Mesh) => true,
            (Self::Csv, Kind::Table | Kind::Field | Kind::Report) => true,
            (Self::Json, Kind::List(item)) => self.holds(*item),
            (Self::Json, kind) => is_plain(kind),
            _ => false,
        }
    }
}

/// Whether a value of this kind is a few numbers and texts, or rows of them.
fn is_plain(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::Bool
            | Kind::Integer
            | Kind::Number
            | Kind::Text
            | Kind::Vector
            | Kind::Choice
            | Kind::Report
            | Kind::Table
            | Kind::Field
    )
}

/// The extensions that a value of this kind can be written with, best first.
pub(crate) fn extensions_for(kind: Kind) -> &'static [&'static str] {
    match kind {
        Kind::Mesh => &[".glb", ".obj", ".stl", ".ply", ".png"],
        Kind::Table | Kind::Field => &[".csv", ".json"],
        Kind::Report => &[".json", ".csv"],
        kind if FileFormat::Json.holds(kind) => &[".json"],
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extensions_choose_in_any_case() {
        assert_eq!(
            FileFormat::of_path("out/A.GLB"),
            Some(FileFormat::Mesh(Format::Glb))
        );
        assert_eq!(FileFormat::of_path("a.b.json"), Some(FileFormat::Json));
        for none in ["a", "a.dwg", "a.gltf", "out.csv/a", ".csv", "a."] {
            assert_eq!(FileFormat::of_path(none), None, "{none}");
        }
    }

    #[test]
    fn what_is_offered_holds() {
        const MESHES: Kind = Kind::List(&Kind::Mesh);
        const NUMBERS: Kind = Kind::List(&Kind::Number);
        for kind in [
            Kind::Bool,
            Kind::Integer,
            Kind::Number,
            Kind::Text,
            Kind::Vector,
            Kind::Choice,
            Kind::Mesh,
            Kind::Directions,
            Kind::Field,
            Kind::Formula,
            Kind::Report,
            Kind::Table,
            MESHES,
            NUMBERS,
        ] {
            let offered = extensions_for(kind);
            for extension in [".glb", ".obj", ".stl", ".ply", ".png", ".json", ".csv"] {
                let format = FileFormat::of_path(&format!("a{extension}")).unwrap();
                assert_eq!(
                    format.holds(kind),
                    offered.contains(&extension),
                    "{kind:?} {extension}"
                );
            }
        }
        assert!(extensions_for(MESHES).is_empty());
        assert_eq!(extensions_for(NUMBERS), [".json"]);
    }
}
