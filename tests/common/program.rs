//! The program as it is typed, in a folder of its own.
#![allow(dead_code)] // Not every file needs all of it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use dyelapse::record::Manifest;
use tempfile::TempDir;

pub fn dyelapse(folder: &TempDir) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dyelapse"));
    command.current_dir(folder.path());
    command
}

pub fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Every file below a folder and its bytes.
pub fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_file())
        .map(|path| {
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            (name, fs::read(&path).unwrap())
        })
        .collect()
}

pub fn manifest(folder: &Path) -> Manifest {
    ron::from_str(&fs::read_to_string(folder.join("recording.ron")).unwrap()).unwrap()
}

pub fn said(command: &mut Command) -> (i32, String) {
    let output = command.output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code().unwrap_or(-1), text)
}
