//! A crate beside the bench's own build, of one file that depends on `vi-core`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// The crate.
pub(crate) struct Project {
    folder: PathBuf,
}

impl Project {
    pub(crate) fn new() -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("expansion");
        let core = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../vi-core");
        fs::create_dir_all(folder.join("src")).expect("a folder");
        let manifest = format!(
            "[package]\nname = \"expansion\"\nversion = \"0.0.0\"\nedition = \"2024\"\n[dependencies]\nvi-core = {{ path = '{}' }}\n[workspace]\n",
            core.display()
        );
        fs::write(folder.join("Cargo.toml"), manifest).expect("a manifest");
        Self { folder }
    }

    pub(crate) fn write(&self, text: &str) {
        fs::write(self.folder.join("src/main.rs"), text).expect("a file");
    }

    /// Seconds that a build takes.
    pub(crate) fn build(&self, release: bool) -> f64 {
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["build", "--quiet"]).args(release.then_some("--release")).current_dir(&self.folder);
        let start = Instant::now();
        let status = cargo
            .env("RUSTFLAGS", "--cap-lints allow")
            .env("CARGO_TARGET_DIR", self.folder.join("target"))
            .status()
            .expect("cargo runs");
        assert!(status.success(), "the expansion does not compile");
        start.elapsed().as_secs_f64()
    }

    /// The output of the release build.
    pub(crate) fn output(&self) -> String {
        let program = self.folder.join("target/release/expansion");
        let output = Command::new(program).output().expect("the program runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }
}
