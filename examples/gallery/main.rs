//! Pictures of the ready systems with constraints, for `docs/gallery.md`.
//!
//! In: nothing. Out: an SVG file for each system in `docs/figures/gallery`: the mechanism at some instants, the path of a
//! point, and charts of the motion. `cargo run --release --example gallery`

mod mechanisms;
mod svg;

use std::error::Error;
use std::fs;
use std::path::Path;

/// Writes all pictures.
fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/figures/gallery");
    fs::create_dir_all(&folder)?;
    for (name, picture) in mechanisms::all()? {
        let path = folder.join(name).with_extension("svg");
        fs::write(&path, picture.svg())?;
        println!("{}", path.display());
    }
    Ok(())
}
