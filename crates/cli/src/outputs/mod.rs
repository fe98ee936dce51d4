//! Outputs: settled before a run, written after it.

mod current;
mod encode;
mod format;
mod tables;
mod target;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use tessgraph_graph::eval::OutputRecord;
use tessgraph_graph::{Diagnostic, Engine, Evaluation, Plan};

pub(crate) use current::OutputObserver;
#[cfg(test)]
pub(crate) use format::FileFormat;
pub(crate) use tables::{csv_field, csv_number};
pub(crate) use target::{Folders, InputFile, Target, input_files, targets};

use crate::atomic::{Put, put_if_changed};
use crate::interrupt;
use crate::places::is_same_file;
use crate::text::printable;
use crate::world::ReadFiles;
use encode::{Content, EncodedFile, Failure, LIBRARY_MARK, encode, made_from};
use target::onto_input;

/// A file of an output that was written, or was there already.
#[derive(Debug, Clone)]
pub(crate) struct WrittenOutput {
    /// Its path as written in the graph; a material library's is made of it.
    pub(crate) name: String,
    /// Its path for people: from where they are.
    pub(crate) shown: String,
    /// Bytes of the file.
    pub(crate) bytes: u64,
    /// Whether the file was replaced; if not, it held these bytes already.
    pub(crate) changed: bool,
    /// What the format could not hold, a sentence each without a full stop.
    pub(crate) lost: Vec<String>,
}

/// The outputs of one run: which of them are still as an earlier run wrote
/// them, and the way to write the others.
pub(crate) struct Outputs<'a> {
    plan: &'a Plan,
    targets: &'a [Target],
    engine: &'a Engine,
    /// Records that the files were found to agree with, by the target's path.
    current: Mutex<BTreeMap<PathBuf, OutputRecord>>,
}

impl<'a> Outputs<'a> {
    pub(crate) fn new(plan: &'a Plan, targets: &'a [Target], engine: &'a Engine) -> Self {
        Self {
            plan,
            targets,
            engine,
            current: Mutex::default(),
        }
    }

    /// Writes everything that could be computed and is not there already;
    /// `read` are the files that the run read. Stops where the user asks to, and
    /// before the next output where `stop` is set.
    pub(crate) fn write(
        &self,
        evaluation: &Evaluation,
        read: &ReadFiles,
        stop: &AtomicBool,
    ) -> (Vec<WrittenOutput>, Vec<Diagnostic>) {
        let (mut outputs, mut problems) = (Vec::new(), Vec::new());
        for target in self.targets {
            if stop.load(Ordering::Relaxed) {
                break;
            }
            match self.write_one(target, evaluation, read) {
                Ok(written) => outputs.extend(written),
                Err(_) if interrupt::is_requested() => break,
                Err(problem) => problems.push(*problem),
            }
        }
        (outputs, problems)
    }

    /// Sees to one output; nothing if its value could not be computed. When it
    /// cannot be written, whatever was at the place is untouched.
    fn write_one(
        &self,
        target: &Target,
        evaluation: &Evaluation,
        read: &ReadFiles,
    ) -> Result<Vec<WrittenOutput>, Box<Diagnostic>> {
        let result = target.result;
        let known = evaluation.identity(result);
        let Some((identity, provenance)) = known.zip(evaluation.provenance(result)) else {
            return Ok(Vec::new());
        };
        self.check_inputs(target, &target.path, read)?;
        let made_from = made_from(self.plan, target, identity, provenance);
        if let Some(record) = self.current_record(target, made_from) {
            return Ok(current::found(target, &record));
        }
        let Some(value) = evaluation.value(result) else {
            return Ok(Vec::new());
        };
        let refused = |failure| self.refused(target, failure);
        let files = encode(self.plan, target, value, provenance).map_err(refused)?;
        let mut put = Vec::new();
        for EncodedFile { path, content } in &files {
            put.push((
                path.as_path(),
                self.write_file(target, path, content, read)?,
            ));
        }
        let mut written: Vec<_> = put
            .iter()
            .map(|(path, put)| WrittenOutput {
                bytes: put.bytes,
                changed: put.changed,
                ..target.file(path)
            })
            .collect();
        let lost: Vec<String> = put.iter().flat_map(|(_, put)| put.made.clone()).collect();
        if let Some(last) = written.last_mut() {
            last.lost.clone_from(&lost);
        }
        if let Some(record) = current::record(made_from, &put, lost) {
            self.engine.keep_output_record(&target.path, &record);
        }
        Ok(written)
    }

    /// Puts a file where it belongs; what that made known is what its format
    /// could not hold.
    fn write_file(
        &self,
        target: &Target,
        path: &Path,
        content: &Content<'_>,
        read: &ReadFiles,
    ) -> Result<Put<Vec<String>>, Box<Diagnostic>> {
        self.check_inputs(target, path, read)?;
        if *path != target.path && is_foreign_library(path) {
            let message = format!(
                "cannot write the materials of `{}`: {} is there already, and was not \
                 written by tessgraph",
                printable(&target.name),
                shown(path)
            );
            let mut problem = self.failed(target, message);
            problem.help = Some(
                "give the output another name, or move that file away if it is not needed"
                    .to_owned(),
            );
            return Err(problem);
        }
        put_if_changed(path, |sink| content.write(sink)).map_err(|failure| match failure {
            Failure::Sink(error) => {
                self.failed(target, format!("cannot write {}: {error}", shown(path)))
            }
            refusal => self.refused(target, refusal),
        })
    }

    /// The value has no bytes in this format.
    fn refused(&self, target: &Target, failure: Failure) -> Box<Diagnostic> {
        let name = printable(&target.name);
        let (message, help) = failure.into_words();
        let mut problem = self.failed(target, format!("cannot write `{name}`: {message}"));
        problem.help = help;
        problem
    }

    /// No file of an output may be one that the run read.
    fn check_inputs(
        &self,
        target: &Target,
        path: &Path,
        read: &ReadFiles,
    ) -> Result<(), Box<Diagnostic>> {
        let mut read = read.iter();
        match read.find(|(input, _)| is_same_file(input, path)) {
            Some((_, name)) => Err(Box::new(onto_input(self.plan, target, name))),
            None => Ok(()),
        }
    }

    fn failed(&self, target: &Target, message: String) -> Box<Diagnostic> {
        let span = target.span.clone();
        let source = &self.plan.source;
        let problem = Diagnostic::error("output_failed", source, span, message, "");
        let help = "what stood there before is untouched; make room or give leave to write, or \
                    write elsewhere with `--out DIR`";
        Box::new(problem.with_help(help))
    }
}

impl Target {
    /// One of the files that this output consists of.
    fn file(&self, path: &Path) -> WrittenOutput {
        let name = if path == self.path {
            self.name.clone()
        } else {
            let beside = path.extension().unwrap_or_default();
            let name = Path::new(&self.name).with_extension(beside);
            name.to_string_lossy().into_owned()
        };
        WrittenOutput {
            name,
            shown: shown(path),
            bytes: 0,
            changed: false,
            lost: Vec::new(),
        }
    }
}

/// Whether a file is there that no earlier run wrote as a material library.
fn is_foreign_library(path: &Path) -> bool {
    let Ok(file) = File::open(path) else {
        return false;
    };
    let mut begin = Vec::new();
    let read = file.take(LIBRARY_MARK.len() as u64).read_to_end(&mut begin);
    read.is_err() || begin != LIBRARY_MARK
}

/// A path from the current folder, if it lies below it.
pub(crate) fn shown(path: &Path) -> String {
    let here = Path::new(".").canonicalize().ok();
    let below = here.and_then(|here| path.strip_prefix(here).ok());
    printable(&below.unwrap_or(path).to_string_lossy()).into_owned()
}
