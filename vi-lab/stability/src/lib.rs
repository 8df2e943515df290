//! `vi-lab stability`: limits of the methods as maps, with advice.
//!
//! In: a folder, and perhaps a system. Out: in the folder a page `index.html`, and for every map and chart an SVG and a CSV
//! file. With a system, the page maps the endings of its runs. Without one, and in a program that has none of its own,
//! it has a section for each kind of failure, with the boundary of theory over the endings of runs. Colours and names
//! distinguish a solver that finds no step from a motion that grows without bound.
//!
//! | module | contents |
//! |---|---|
//! | `fixed`, `composed`, `energy` | the sections of the page, as data |
//! | `system`, `span` | the maps of one system, and their axes |
//! | `atlas`, `contour`, `ending` | sections and maps; curves D = 0; endings of runs and their colours |
//! | `trial` | systems that only the charts need |

mod atlas;
mod composed;
mod contour;
mod ending;
mod energy;
mod fixed;
mod span;
mod system;
#[allow(dead_code, unreachable_pub)] // generated for users; the charts need a part
mod trial;

use atlas::Section;
use clap::Args;
use std::path::PathBuf;
use vi_report::catalogue::{Catalogue, kebab, with_rule};
use vi_report::entry::Entry;
use vi_report::failure::Failure;
use vi_report::page::Report;

/// `vi-lab stability [SYSTEM]`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// System of the catalogue [default: the first system of this program's own; of a program without one, the page of all systems]
    system: Option<String>,
    /// Folder for the page, its figures (SVG) and their data (CSV)
    #[arg(long, value_name = "DIR", default_value = "stability")]
    out: PathBuf,
    /// Cells in a row of a map
    #[arg(long, value_name = "N", default_value_t = 149, value_parser = clap::value_parser!(u16).range(10..=596))]
    columns: u16,
    /// Horizontal axis of the system's maps: a coordinate, a velocity (v_x), a parameter, or h, as NAME=LOW:HIGH
    #[arg(long, value_name = "NAME=LOW:HIGH", allow_hyphen_values = true)]
    x: Option<String>,
    /// Vertical axis
    #[arg(long, value_name = "NAME=LOW:HIGH", allow_hyphen_values = true)]
    y: Option<String>,
}

/// Writes the page and its files, and returns the path of the page.
///
/// # Errors
/// [`Failure::Input`] for a system or an axis that does not exist, [`Failure::File`] if a file cannot be written.
pub fn write(arguments: &Arguments, catalogue: &Catalogue) -> Result<String, Failure> {
    let entry = match &arguments.system {
        Some(name) => Some(catalogue.find(name)?),
        None => catalogue.own(),
    };
    if entry.is_none() && (arguments.x.is_some() || arguments.y.is_some()) {
        return Err(Failure::Input("--x and --y are axes of the map of one system: name it".to_owned()));
    }
    let mut report;
    if let Some(entry) = entry {
        let entry = with_rule(entry, "stability")?;
        let axes = system::axes(&entry, arguments.x.as_deref(), arguments.y.as_deref())?;
        let title = format!("Endings of runs of the system {}", kebab(entry.name));
        report = Report::new(&arguments.out, &title, entry.about)?;
        atlas::write(&mut report, arguments.columns, system::sections(&entry, &axes));
    } else {
        report = Report::new(&arguments.out, "Limits of the methods", SUBTITLE)?;
        report.prose(INTRODUCTION);
        let [well, pendulum] = ["double-well", "pendulum"].map(|name| catalogue.find(name));
        let (well, pendulum) = (well?, pendulum?);
        atlas::write(&mut report, arguments.columns, sections(&well, &pendulum)?);
    }
    Ok(report.finish()?.display().to_string())
}

const SUBTITLE: &str =
    "Variational integrators with fixed and with energy-preserving steps: which steps exist, and which are stable";
const INTRODUCTION: &str = "Each chart shows the endings of runs over two quantities. The dashed line is the boundary of theory. Colours \
     mean the same in all maps: <b style=\"background:#E3ECF4\">pale</b> runs to the end; <b \
     style=\"background:#E69F00\">orange</b> grows without bound: the method is unstable. The other colours are typed \
     errors of the solver for steps that do not exist, first of all <b \
     style=\"background:#CC79A7\">no forward step</b> of the energy-preserving integrator and <b \
     style=\"background:#3A3A3A;color:#FFFFFF\">no solution</b> of the momentum equation. No run returns NaN.";

/// The sections of all kinds of failure.
fn sections<'a>(well: &'a Entry, pendulum: &'a Entry) -> Result<Vec<Section<'a>>, Failure> {
    Ok(vec![
        fixed::linear(),
        fixed::resonance(),
        fixed::roots(),
        fixed::stiff(),
        composed::section(),
        energy::kepler(),
        energy::separatrix(well, pendulum)?,
        energy::orders(pendulum.system.as_ref()),
    ])
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use std::fs;
    use vi_report::catalogue::Systems;

    /// The ready systems.
    pub(crate) fn catalogue() -> Catalogue {
        Catalogue { own: None, ready: Systems { sources: &[], entries: vi_ready::systems }, of_text: None }
    }

    #[test]
    fn a_coarse_page_has_every_file() {
        let out = std::env::temp_dir().join(format!("vi-lab-stability-{}", std::process::id()));
        let arguments = Arguments { system: None, out: out.clone(), columns: 6, x: None, y: None };
        let place = write(&arguments, &catalogue()).unwrap_or_else(|failure| panic!("{failure}"));
        let page = fs::read_to_string(place).expect("the page");
        let files: Vec<&str> = page
            .split("href=\"")
            .skip(1)
            .filter_map(|rest| rest.split('"').next())
            .filter(|name| !name.starts_with('#'))
            .collect();
        // 18 maps and a chart, in two forms each, and a table.
        assert_eq!(files.len(), 2 * 19 + 1);
        for name in files {
            let text = fs::read_to_string(out.join(name)).unwrap_or_default();
            assert!(text.len() > 100 && !text.contains("NaN"), "{name}");
        }
        fs::remove_dir_all(&out).expect("the folder can be removed");
    }
}
