//! Sweeps: shards against the whole, interrupted processes, results of a run, wrong input, a scheduler.

use super::{bits, lab, path, rows, send, success, temporary};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// Names and bytes of chunks.
type Chunks = BTreeMap<String, Vec<u8>>;

/// The names of the files in a folder; empty if it does not exist.
fn names(folder: &Path) -> Vec<String> {
    let files = fs::read_dir(folder).into_iter().flatten().flatten();
    files.map(|file| file.file_name().into_string().expect("text")).collect()
}

/// A folder for one test with a scene, removed on drop.
pub(super) struct Folder(PathBuf);

impl Folder {
    pub(super) fn new(name: &str, scene: &str) -> Self {
        let folder = Self(temporary(name));
        fs::create_dir_all(&folder.0).expect("a folder");
        fs::write(folder.0.join("scene.toml"), scene).expect("a scene");
        folder
    }

    /// A file in it.
    pub(super) fn at(&self, name: &str) -> String {
        path(&self.0.join(name)).to_owned()
    }

    /// A file with a text.
    pub(super) fn file(&self, name: &str, text: &str) -> String {
        fs::write(self.0.join(name), text).expect("the file is written");
        self.at(name)
    }

    pub(super) fn scene(&self) -> String {
        self.at("scene.toml")
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.0.join(name)).expect("the file")
    }

    /// Whether a temporary file is left.
    fn has_temporary(&self) -> bool {
        names(&self.0).iter().any(|name| name.contains(".tmp"))
    }

    /// The chunks of a part.
    fn chunks(&self, part: &str) -> Chunks {
        let names = names(&self.0.join(part))
            .into_iter()
            .filter(|name| Path::new(name).extension().is_some_and(|extension| extension == "csv"));
        names.map(|name| (name.clone(), self.read(&format!("{part}/{name}")))).collect()
    }

    pub(super) fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).expect("text")
    }

    /// A successful sweep of its scene, or of a shard.
    fn sweep(&self, output: &str, shard: &[&str]) -> String {
        let (scene, output) = (self.scene(), self.at(output));
        success(&[["sweep", &scene, "-o", &output].as_slice(), shard].concat())
    }

    /// Starts a sweep of its scene, or of a shard.
    fn start(&self, output: &str, shard: &[&str]) -> Child {
        let (scene, output) = (self.scene(), self.at(output));
        start(&[["sweep", &scene, "-o", &output].as_slice(), shard].concat())
    }

    /// Whether the tables of a sweep of `MIXED` equal those of an undivided one.
    fn is_whole(&self, name: &str, what: &str) {
        for file in ["csv", "section.csv", "series.csv"] {
            assert!(self.read(&format!("{name}.{file}")) == self.read(&format!("whole.{file}")), "{file} of {what}");
        }
    }

    /// Merges parts; returns status and standard error.
    fn merge(&self, parts: &[&str], output: &str) -> (Option<i32>, String) {
        let parts: Vec<String> = parts.iter().map(|part| self.at(part)).collect();
        let output = self.at(output);
        let mut arguments = vec!["merge", "-o", &output];
        arguments.extend(parts.iter().map(String::as_str));
        let (status, _, errors) = lab(&arguments);
        (status, errors.replace(&self.at(""), ""))
    }

    /// The message of a rejected sweep.
    fn refused(&self, entries: &str, arguments: &[&str]) -> String {
        fs::write(self.scene(), format!("system = \"kepler\"\n{entries}")).expect("a scene");
        let (scene, output) = (self.scene(), self.at("refused.csv"));
        let (status, diagnostic, errors) = lab(&[["sweep", &scene, "-o", &output].as_slice(), arguments].concat());
        assert_eq!((status, diagnostic.as_str(), errors.lines().count()), (Some(2), "", 1), "{errors}");
        errors.trim_end().replace(&self.at(""), "").replace("error: ", "")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Starts the command with one thread: the remaining work does not depend on the number of cores.
fn start(arguments: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vi-lab"));
    command.args(arguments).env("RAYON_NUM_THREADS", "1");
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the command starts")
}

/// 48 runs, completed and failed, with all tables.
const MIXED: &str = "
system = \"double-well\"
method = \"energy\"
h = 0.05
steps = 100
every = 30
[sweep]
over = [
    { name = \"m\", values = [0.5, 1.0] },
    { name = \"q\", from = 0.7, to = 1.05, count = 8 },
    { name = \"v_q\", normal = [0.0, 0.05] },
]
samples = 3
seed = 5
keep = [\"ending\", \"end\", \"extremes\", \"energy\", \"series\"]
section = { coordinate = \"q\", at = 0.75, direction = \"both\" }
";

/// Runs of 20000 steps, one per chunk.
const LONG: &str = "
system = \"double-well\"
method = \"energy\"
steps = 20000
[sweep]
over = [{ name = \"q\", from = 0.71, to = 0.75, count = 80 }]
";

/// More runs than can be computed, 200 per chunk.
const ENDLESS: &str = "
system = \"kepler\"
steps = 1000
[sweep]
over = [{ name = \"x\", uniform = [0.9, 1.1] }]
samples = 1e15
";

#[test]
fn shards_are_the_whole_byte_for_byte() {
    let folder = Folder::new("shards", MIXED);
    let diagnostic = folder.sweep("whole.csv", &[]);
    assert!(diagnostic.contains("whole.csv: 48 runs, 10 did not reach their end"), "{diagnostic}");
    assert!(!folder.0.join("whole.csv.part").exists(), "its rows stand in tables");
    for count in [1, 2, 7, 100] {
        let part = format!("{count}.csv.part");
        // In any order, and some twice.
        for index in (0..count).rev().chain([0]) {
            folder.sweep(&format!("{count}.csv"), &["--shard", &format!("{index}/{count}")]);
        }
        assert_eq!(folder.merge(&[&part], "merged.csv"), (Some(0), String::new()));
        folder.is_whole("merged", &format!("{count} shards"));
    }
    // Machines without a common file system have their own folders. The number of shards may change.
    for (output, shard) in [("a.csv", "0/3"), ("b.csv", "2/3"), ("b.csv", "1/2")] {
        folder.sweep(output, &["--shard", shard]);
    }
    let missing = "chunk 16 of 48 is missing, runs 16 to 16; `vi-lab sweep` computes it";
    let expected = (Some(2), format!("error: {missing}\n"));
    assert_eq!(folder.merge(&["b.csv.part", "a.csv.part"], "c.csv"), expected);
    folder.sweep("a.csv", &["--shard", "0/2"]);
    assert_eq!(folder.merge(&["b.csv.part", "a.csv.part"], "c.csv"), (Some(0), String::new()));
    folder.is_whole("c", "two folders");
    // Two processes that write the same chunks.
    for child in ["0/1", "0/1"].map(|shard| folder.start("d.csv", &["--shard", shard])) {
        assert!(child.wait_with_output().expect("the command ends").status.success());
    }
    assert_eq!(folder.merge(&["d.csv.part"], "d.csv"), (Some(0), String::new()));
    folder.is_whole("d", "two processes");
    // Without --shard the sweep computes the missing chunks, merges and removes the folder.
    folder.sweep("b.csv", &[]);
    folder.is_whole("b", "a sweep that goes on from shards");
    assert!(!folder.0.join("b.csv.part").exists());
}

#[test]
fn an_item_is_the_run_alone_and_a_failure_is_recorded() {
    let folder = Folder::new("item", MIXED);
    folder.sweep("whole.csv", &[]);
    let whole = folder.text("whole.csv");
    let series = rows(&folder.text("whole.series.csv"));
    let mut failed = 0;
    for item in [0, 11, 23, 47] {
        let line = whole.lines().filter(|line| !line.starts_with('#')).nth(1 + item).expect("a row");
        let (status, csv, errors) = lab(&["run", &folder.scene(), "--item", &item.to_string()]);
        let alone = rows(&csv);
        let kept: Vec<f64> = line.split(',').skip(6).take(6).map(|entry| entry.parse().expect("a number")).collect();
        assert_eq!(bits(&[kept]), bits(&alone[alone.len() - 1..]), "{line}");
        // Every 30th node and the last; the same rows as in the series.
        let number = f64::from(u8::try_from(item).expect("a few")).to_bits();
        let thinned: Vec<Vec<f64>> =
            series.iter().filter(|row| row[0].to_bits() == number).map(|row| row[1..].to_vec()).collect();
        assert_eq!(bits(&thinned), bits(&alone));
        let is_failed = line.contains("no forward step");
        failed += usize::from(is_failed);
        assert_eq!(
            (status, errors.contains("no energy-preserving step exists past")),
            (Some(i32::from(is_failed)), is_failed)
        );
        if is_failed {
            assert!(errors.contains(&format!("after {} steps", line.split(',').nth(5).expect("steps"))), "{errors}");
        }
    }
    assert_eq!(failed, 2);
}

#[test]
fn what_is_kept_of_a_run_is_what_its_rows_say() {
    let folder = Folder::new(
        "kept",
        "system = \"kepler\"\nsteps = 200\n[sweep]\nover = [{ name = \"v_y\", values = [1.9, 2.1] }]\nkeep = [\"energy\", \"extremes\"]\n",
    );
    folder.sweep("kept.csv", &[]);
    let text = folder.text("kept.csv");
    assert!(text.contains("\nitem,v_y,min_x,max_x,min_y,max_y,min_H,max_H,error_H,error_E\n"), "{text}");
    for (item, kept) in rows(&text).iter().enumerate() {
        let (_, csv, _) = lab(&["run", &folder.scene(), "--item", &item.to_string()]);
        let nodes = rows(&csv);
        let column = |index: usize| nodes.iter().map(move |row| row[index]).filter(|value| !value.is_nan());
        let range = |index: usize| {
            [column(index).fold(f64::INFINITY, f64::min), column(index).fold(f64::NEG_INFINITY, f64::max)]
        };
        let drift = |index: usize| {
            let first = column(index).next().expect("an energy");
            column(index).map(|energy| (energy - first).abs()).fold(0.0, f64::max)
        };
        let expected = [range(1), range(2), range(5), [drift(5), drift(6)]].concat();
        assert_eq!(bits(&[kept[2..].to_vec()]), bits(&[expected]));
    }
}

#[test]
fn crossings_are_where_the_motion_is_known() {
    let scene = |section: &str| {
        format!(
            "system = \"harmonic-oscillator\"\nmethod = \"gauss\"\nh = 0.1\nuntil = 20.0\n[parameters]\nm = 1\n[sweep]\n\
             over = [{{ name = \"k\", values = [1.0, 4.0] }}]\nsection = {section}\n"
        )
    };
    let folder = Folder::new("section", &scene("{ coordinate = \"x\", at = 0.5, direction = \"falling\" }"));
    folder.sweep("a.csv", &[]);
    let crossings = rows(&folder.text("a.section.csv"));
    // cos(ω t) falls to 1/2 at ω t = π/3 + 2π n: with ω = 1 at four times up to 20, with ω = 2 at seven.
    let third = core::f64::consts::FRAC_PI_3;
    let mut expected: Vec<(f64, f64)> = Vec::new();
    for (item, omega, count) in [(0.0_f64, 1.0, 4), (1.0, 2.0, 7)] {
        expected.extend((0..count).map(|turn| (item, (third + core::f64::consts::TAU * f64::from(turn)) / omega)));
    }
    assert_eq!(crossings.len(), expected.len());
    for (row, (item, t)) in crossings.iter().zip(&expected) {
        // Measured 3.6e-15 and 0.
        assert!(
            row[0].to_bits() == item.to_bits() && (row[1] - t).abs() < 4e-15 && (row[2] - 0.5).abs() < 2e-16,
            "{row:?} {t}"
        );
    }
    fs::write(folder.scene(), scene("{ period = 3.0 }")).expect("a scene");
    folder.sweep("b.csv", &[]);
    let crossings = rows(&folder.text("b.section.csv"));
    assert_eq!(crossings.len(), 12);
    for (index, row) in crossings.iter().enumerate() {
        let turn = 3.0 * f64::from(u8::try_from(index % 6).expect("a few") + 1);
        let omega = row[0] + 1.0;
        // Measured 0 and 3.9e-15: a crossing is the last length of the step before the section.
        assert!((row[1] - turn).abs() < 4e-15 && (row[2] - (omega * turn).cos()).abs() < 5e-15, "{row:?} {turn}");
    }
}

#[cfg(unix)]
#[test]
fn a_process_that_ends_early_loses_its_chunks_and_repeats_nothing() {
    let folder = Folder::new("killed", LONG);
    folder.sweep("whole.csv", &["--shard", "0/1"]);
    let whole = folder.chunks("whole.csv.part");
    assert_eq!(whole.len(), 80);
    let (scene, output, part) = (folder.scene(), folder.at("killed.csv"), "killed.csv.part");
    let times = |chunks: &Chunks| -> Vec<_> {
        let time =
            |name: &String| fs::metadata(folder.at(&format!("{part}/{name}"))).and_then(|chunk| chunk.modified());
        chunks.keys().map(|name| (name.clone(), time(name).expect("a time"))).collect()
    };
    let mut before = Vec::new();
    for (signal, status) in [("-KILL", None), ("-INT", Some(130)), ("-KILL", None), ("-TERM", Some(143))] {
        let child = start(&["sweep", &scene, "-o", &output]);
        while folder.chunks(part).len() < before.len() + 8 {
            sleep(Duration::from_millis(1));
        }
        send(signal, &child);
        let Output { status: ended, stderr, .. } = child.wait_with_output().expect("the command ends");
        let errors = String::from_utf8(stderr).expect("text");
        assert_eq!(ended.code(), status, "{errors}");
        if status.is_some() {
            assert!(
                errors.contains(
                    " of 80 chunks; the same command resumes from them; the output up to this point is complete"
                ),
                "{errors}"
            );
        }
        let chunks = folder.chunks(part);
        assert!(chunks.len() < 80 && chunks.iter().all(|(name, chunk)| whole[name] == *chunk), "{signal}");
        let after = times(&chunks);
        assert!(before.iter().all(|chunk| after.contains(chunk)), "no chunk is written twice");
        let temporary = names(&folder.0.join(part)).into_iter().filter(|name| name.contains(".tmp"));
        assert!(temporary.count() <= 1, "what the process before left is removed");
        before = after;
    }
    folder.sweep("killed.csv", &["--shard", "0/1"]);
    let chunks = folder.chunks(part);
    let after = times(&chunks);
    assert!(chunks == whole && before.iter().all(|chunk| after.contains(chunk)));
    folder.sweep("killed.csv", &[]);
    assert_eq!(folder.merge(&["whole.csv.part"], "whole.csv"), (Some(0), String::new()));
    assert!(folder.text("killed.csv") == folder.text("whole.csv") && !folder.0.join(part).exists());
}

/// Six runs of 4, 8, … 128 steps, each in a chunk of the length of its series.
const GROWING: &str = "
system = \"double-well\"
until = 1.0
[sweep]
over = [{ name = \"h\", from = 0.25, to = 0.0078125, count = 6, spacing = \"log\" }]
keep = [\"ending\", \"end\", \"series\"]
";

#[cfg(unix)]
#[test]
fn a_disk_that_is_full_keeps_the_chunks_before() {
    let folder = Folder::new("full-sweep", GROWING);
    folder.sweep("whole.csv", &["--shard", "0/1"]);
    let whole = folder.chunks("whole.csv.part");
    // 20 blocks of 512 bytes: more than five of the chunks and the heading, less than the last chunk and the table of
    // the series.
    let lengths: Vec<usize> = whole.values().map(Vec::len).collect();
    assert!(lengths[4] < 10240 && lengths[5] > 10240, "{lengths:?}");
    let limited = "trap '' XFSZ; ulimit -f 20; exec \"$0\" \"$@\"";
    let run = |arguments: &[&str]| {
        let all = [["-c", limited, env!("CARGO_BIN_EXE_vi-lab")].as_slice(), arguments].concat();
        let Output { status, stderr, .. } =
            Command::new("sh").env("RAYON_NUM_THREADS", "1").args(all).output().expect("the shell runs");
        (status.code(), String::from_utf8(stderr).expect("text"))
    };
    let (scene, output) = (folder.scene(), folder.at("full.csv"));
    let part = folder.at("full.csv.part");
    let (status, errors) = run(&["sweep", &scene, "-o", &output]);
    assert_eq!((status, errors.lines().count()), (Some(1), 1), "{errors}");
    let advice = "the other chunks are complete; correct the error, then the same command resumes from them\n";
    assert!(errors.starts_with(&format!("error: {part}/5.csv: ")) && errors.ends_with(advice), "{errors}");
    let kept = folder.chunks("full.csv.part");
    assert!(kept.len() == 5 && kept.iter().all(|(name, chunk)| whole[name] == *chunk));
    assert!(!names(&folder.0.join("full.csv.part")).iter().any(|name| name.contains(".tmp")));
    folder.sweep("full.csv", &["--shard", "0/1"]);
    folder.file("full.csv", "mine");
    folder.file("full.series.csv", "mine");
    let (status, errors) = run(&["merge", &part, "-o", &output]);
    assert_eq!((status, errors.lines().count()), (Some(1), 1), "{errors}");
    let series = folder.at("full.series.csv");
    assert!(errors.starts_with(&format!("error: {series}: ")) && !folder.has_temporary(), "{errors}");
    assert_eq!(["full.csv", "full.series.csv"].map(|table| folder.text(table)), ["mine", "mine"]);
    folder.sweep("full.csv", &[]);
    folder.sweep("whole.csv", &[]);
    for table in ["", ".series"] {
        assert_eq!(folder.text(&format!("full{table}.csv")), folder.text(&format!("whole{table}.csv")));
    }
}

#[cfg(unix)]
#[test]
fn a_second_process_is_refused_while_the_first_works() {
    let folder = Folder::new("second", ENDLESS);
    let (scene, output, part) = (folder.scene(), folder.at("a.csv"), "a.csv.part");
    let shard = ["--shard", "0/2"].as_slice();
    // A process that computes all is alone; shards are not.
    for (options, others) in [([].as_slice(), vec![[].as_slice(), shard]), (shard, vec![[].as_slice()])] {
        let before = folder.chunks(part);
        let first = folder.start("a.csv", options);
        while folder.chunks(part).len() < before.len() + 1 {
            sleep(Duration::from_millis(1));
        }
        for other in others {
            let second = lab(&[["sweep", &scene, "-o", &output].as_slice(), other].concat());
            let message = format!("error: another process uses {}; wait for it\n", folder.at(part));
            assert_eq!(second, (Some(2), String::new(), message));
        }
        let before = folder.chunks(part);
        while folder.chunks(part).len() < before.len() + 2 {
            sleep(Duration::from_millis(1));
        }
        send("-INT", &first);
        let ended = first.wait_with_output().expect("the command ends");
        assert_eq!(ended.status.code(), Some(130));
        let after = folder.chunks(part);
        assert!(before.iter().all(|(name, chunk)| after[name] == *chunk));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_sweep_of_any_length_starts_in_bounded_memory_and_goes_on() {
    let scene =
        "system = \"kepler\"\nsteps = 1000\n[sweep]\nover = [{ name = \"x\", uniform = [0.9, 1.1] }]\nsamples = 1e15\n";
    let folder = Folder::new("endless", scene);
    let (scene, output, part) = (folder.scene(), folder.at("a.csv"), "a.csv.part");
    // One bit per chunk would be 300 times this limit of 2 GB.
    let limited = "ulimit -v 2000000; exec \"$0\" \"$@\"";
    let mut before = Chunks::new();
    for _ in 0..2 {
        let child = Command::new("sh")
            .args(["-c", limited, env!("CARGO_BIN_EXE_vi-lab"), "sweep", &scene, "-o", &output])
            .env("RAYON_NUM_THREADS", "2")
            .stderr(Stdio::piped())
            .spawn()
            .expect("the shell runs");
        while folder.chunks(part).len() < before.len() + 2 {
            sleep(Duration::from_millis(1));
        }
        send("-INT", &child);
        let Output { status, stderr, .. } = child.wait_with_output().expect("the command ends");
        let errors = String::from_utf8(stderr).expect("text");
        assert_eq!(status.code(), Some(130), "{errors}");
        assert!(errors.contains(" of 5000000000000 chunks; the same command resumes from them"), "{errors}");
        let after = folder.chunks(part);
        assert!(before.iter().all(|(name, chunk)| after[name] == *chunk));
        before = after;
    }
    let missing = (0..1000).find(|number| !before.contains_key(&format!("{number}.csv"))).expect("a chunk");
    let runs = format!("runs {} to {}", 200 * missing, 200 * missing + 199);
    let expected = format!("chunk {missing} of 5000000000000 is missing, {runs}; `vi-lab sweep` computes it");
    assert_eq!(folder.merge(&[part], "merged.csv"), (Some(2), format!("error: {expected}\n")));
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let folder = Folder::new("threads", MIXED);
    let (scene, part) = (folder.scene(), "a.csv.part");
    let mut first: Option<Chunks> = None;
    for threads in ["1", "2", "5"] {
        let status = Command::new(env!("CARGO_BIN_EXE_vi-lab"))
            .args(["sweep", &scene, "-o", &folder.at("a.csv"), "--shard", "0/1"])
            .env("RAYON_NUM_THREADS", threads)
            .stdout(Stdio::null())
            .status();
        assert!(status.expect("the command runs").success());
        let chunks = folder.chunks(part);
        assert_eq!(chunks.len(), 48);
        assert!(*first.get_or_insert_with(|| chunks.clone()) == chunks, "{threads} threads");
        fs::remove_dir_all(folder.at(part)).expect("the part goes");
    }
}

#[test]
fn a_chunk_that_was_changed_is_named_and_made_again() {
    let folder = Folder::new("changed", MIXED);
    folder.sweep("whole.csv", &[]);
    folder.sweep("a.csv", &["--shard", "0/1"]);
    let part = "a.csv.part";
    let path = folder.at(&format!("{part}/7.csv"));
    let good = fs::read_to_string(&path).expect("a chunk");
    let remedy = "remove this file, and run the same `vi-lab sweep` again";
    let changed = format!("{part}/7.csv: the checksum does not match: the file was edited or cut off; {remedy}");
    for bad in [
        good.replacen("series,7,0.0,", "series,7,0.035,", 1),
        good.replacen("\nseries,", "\nseries,7,0.0,0.0,0.0,0.0,0.0,0.0\nseries,", 1),
        good.replacen("failed", "lost", 1),
        good.replacen("# 0 failed", "# 1 failed", 1),
        good[..good.rfind('#').expect("a last line")].to_owned(),
        good.clone() + "\n",
        good.trim_end().to_owned(),
    ] {
        assert!(bad != good);
        fs::write(&path, bad).expect("the chunk is written");
        let expected = (Some(2), format!("error: {changed}\n"));
        assert_eq!(folder.merge(&[part], "a.csv"), expected);
        let (status, diagnostic, errors) = lab(&["sweep", &folder.scene(), "-o", &folder.at("a.csv")]);
        assert_eq!((status, errors.replace(&folder.at(""), "")), expected, "{diagnostic}");
        assert!(!folder.0.join("a.csv").exists() && !folder.has_temporary());
    }
    // Files that are not chunks of this sweep are rejected and rewritten, as are missing ones.
    fs::write(&path, good.replacen("chunk 7", "chunk 8", 1)).expect("the chunk is written");
    let another = format!("{part}/7.csv: this is a chunk of another sweep, or another chunk; {remedy}");
    assert_eq!(folder.merge(&[part], "a.csv"), (Some(2), format!("error: {another}\n")));
    fs::remove_file(folder.at(&format!("{part}/9.csv"))).expect("the chunk goes");
    folder.sweep("a.csv", &[]);
    for table in ["", ".section", ".series"] {
        assert!(folder.read(&format!("a{table}.csv")) == folder.read(&format!("whole{table}.csv")), "{table}");
    }
}

#[test]
fn chunks_that_do_not_belong_together_are_refused() {
    let folder = Folder::new("merge", LONG);
    let short = LONG.replace("20000", "50").replace("80", "10");
    fs::write(folder.scene(), &short).expect("a scene");
    folder.sweep("a.csv", &["--shard", "1/2"]);
    fs::write(folder.scene(), short.replace("0.75", "0.76")).expect("a scene");
    folder.sweep("b.csv", &["--shard", "0/2"]);
    let (first, second) = ("a.csv.part", "b.csv.part");
    fs::create_dir(folder.at("other.part")).expect("a folder");
    folder.file("other.part/sweep.json", "{}");
    let sweep = |to: &str| format!("`q from 0.71 to {to}, 10 values`");
    let other = format!("its sweep is {}, not {}", sweep("0.76"), sweep("0.75"));
    let remedy = "remove other.part, and run `vi-lab sweep` again";
    for (parts, message) in [
        (vec![first, second], format!("{second} belongs to another sweep than {first}: {other}")),
        (vec![first], "chunk 0 of 10 is missing, runs 0 to 0; `vi-lab sweep` computes it".to_owned()),
        (
            vec!["other.part"],
            format!("other.part/sweep.json does not describe a sweep of this version of vi-lab; {remedy}"),
        ),
    ] {
        assert_eq!(folder.merge(&parts, "merged.csv"), (Some(2), format!("error: {message}\n")));
    }
    let (status, errors) = folder.merge(&["none.part"], "merged.csv");
    let expected = "error: none.part contains no chunks of a sweep: none.part/sweep.json: ";
    assert!(status == Some(2) && errors.starts_with(expected), "{errors}");
    assert_eq!(
        folder.merge(&[first], "merged.parquet"),
        (
            Some(2),
            "error: the output `merged.parquet` must end in .csv; pandas reads it with `read_csv(FILE, comment=\"#\")`\n"
                .to_owned()
        )
    );
    // Chunks of another sweep with valid names.
    for number in 0..5 {
        let name = format!("{number}.csv");
        fs::copy(folder.at(&format!("{second}/{name}")), folder.at(&format!("{first}/{name}"))).expect("a copy");
    }
    let (status, errors) = folder.merge(&[first], "merged.csv");
    let expected = format!("error: {first}/0.csv: this is a chunk of another sweep, or another chunk; ");
    assert!(status == Some(2) && errors.starts_with(&expected), "{errors}");
    assert!(!folder.0.join("merged.csv").exists() && !folder.has_temporary());
    fs::write(folder.scene(), &short).expect("a scene");
    assert!(folder.sweep("a.csv", &["--shard", "0/2"]).contains("a.csv.part: 5 runs, all reached their end"));
    assert_eq!(folder.merge(&[first], "merged.csv"), (Some(0), String::new()));
    // A sweep resumes only from its own chunks.
    let part = "refused.csv.part";
    fs::rename(folder.at(second), folder.at(part)).expect("a folder");
    let over = "[sweep]\nover = [{ name = \"v_y\", values = [1.0] }]\n";
    let message =
        |fact: &str| format!("{part} belongs to another sweep: its {fact}; remove it, or name another output");
    for shard in [&[][..], &["--shard", "1/2"]] {
        assert_eq!(folder.refused(over, shard), message("system is `DoubleWell`, not `Kepler`"));
    }
    let heading = folder.text(&format!("{part}/sweep.json"));
    let version = env!("CARGO_PKG_VERSION");
    folder.file(&format!("{part}/sweep.json"), &heading.replacen(&format!("\"{version}\""), "\"0.0.9\"", 1));
    assert_eq!(folder.refused(over, &[]), message(&format!("vi-lab is `0.0.9`, not `{version}`")));
}

#[test]
fn wrong_sweeps_are_one_line_and_status_2() {
    let folder = Folder::new("wrong", "");
    let over = "[sweep]\nover = [{ name = \"x\", values = [1.0] }]\n";
    for (entries, message) in [
        ("", "scene.toml is not a scene file with a table [sweep]; docs/cluster.md has an example"),
        ("[sweep]\n", "scene.toml: line 2: missing field `over`"),
        (
            "[sweep]\nover = []\nkep = []\n",
            "scene.toml: line 4: unknown field `kep`, expected one of `over`, `samples`, `seed`, `keep`, `section`",
        ),
        (
            "[sweep]\nover = [{ name = \"z\", values = [1.0] }]\n",
            "there is no quantity `z` to vary; the quantities are x, y, v_x, v_y, mu, h",
        ),
        (&format!("{over}keep = []\n"), "`keep` is empty; remove it to keep the end of each run"),
        (
            &format!("{over}section = {{ coordinate = \"z\" }}\n"),
            "the section names the unknown coordinate `z`; the coordinates are x, y",
        ),
        (
            &format!("{over}section = {{ coordinate = \"x\", period = 1.0 }}\n"),
            "the section is { coordinate = \"x\", at = 0.0, direction = \"rising\" } or { period = 1.0 }",
        ),
        (
            &format!("{over}section = {{ period = 0.001 }}\n"),
            "the section has the period 0.001; it must be at least four steps long",
        ),
        (
            &format!("steps = 1e7\n{over}keep = [\"series\"]\n"),
            "the series of each run would have about 10000000 rows, 1710 MB; keep fewer with every = 45 in the scene",
        ),
    ] {
        assert_eq!(folder.refused(entries, &[]), message);
    }
    assert_eq!(folder.refused(over, &["--shard", "7/7"]), "there is no shard 7/7: they are numbered from 0/7 to 6/7");
    fs::write(folder.scene(), format!("system = \"kepler\"\n{over}")).expect("a scene");
    let scene = folder.scene();
    for (arguments, message) in [
        (vec!["run", &scene], "the scene has a [sweep]: use `vi-lab sweep` for all runs, or --item K for one"),
        (vec!["run", &scene, "--item", "1"], "there is no --item 1: the runs are numbered from 0 to 0"),
        (vec!["run", "kepler", "--item", "1"], "only a scene with [sweep] has an --item"),
        (
            vec!["sweep", "kepler", "-o", "x.csv"],
            "kepler is not a scene file with a table [sweep]; docs/cluster.md has an example",
        ),
        (vec!["sweep", &scene, "-o", "no/x.csv"], "there is no folder `no` for the output `no/x.csv`; create it first"),
    ] {
        assert_eq!(lab(&arguments), (Some(2), String::new(), format!("error: {message}\n")));
    }
}

#[test]
fn values_that_no_run_can_have_are_recorded() {
    let scene = "system = \"kepler\"\nuntil = 1.0\n[sweep]\nover = [\n    { name = \"h\", values = [0.01, 0.0, -0.01, 1e-300] },\n    { name = \"x\", values = [0.4, 0.0] },\n]\n";
    let folder = Folder::new("values", scene);
    let diagnostic = folder.sweep("values.csv", &[]);
    assert!(diagnostic.contains("8 runs, 7 did not reach their end"), "{diagnostic}");
    let text = folder.text("values.csv");
    let endings: Vec<&str> =
        text.lines().filter(|line| !line.starts_with('#')).skip(1).filter_map(|line| line.split(',').nth(3)).collect();
    let wrong = "wrong input";
    assert_eq!((endings[0], &endings[2..]), ("reached its end", [wrong; 6].as_slice()), "{text}");
    assert!(text.contains("\n7,1e-300,0.0,wrong input,0,,,,,,,,,\n"), "{text}");
}

/// Submits the shards of a sweep to a server and a worker of HyperQueue, and waits for them.
const HYPERQUEUE: &str = "
import os, sys
from hyperqueue import Job, LocalCluster
from hyperqueue.cluster import WorkerConfig
lab, scene, output, folder, count = sys.argv[1:]
with LocalCluster() as cluster:
    cluster.start_worker(WorkerConfig(cores=2))
    client = cluster.client()
    job = Job(default_workdir=folder, default_env={'RAYON_NUM_THREADS': '1'})
    for _ in range(int(count)):
        job.program([lab, 'sweep', scene, '-o', output, '--shard', count])
    client.wait_for_jobs([client.submit(job)])
";

#[cfg(unix)]
#[test]
fn hyperqueue_makes_the_same_bytes() {
    let python = |arguments: &[&str]| Command::new("python3").args(arguments).stdin(Stdio::null()).output();
    let is_installed = python(&["-c", "import hyperqueue"]).is_ok_and(|output| output.status.success());
    if !is_installed {
        println!(
            "NOT TESTED: there is no HyperQueue here; `pip install hyperqueue`, and python3 in the path has to find it"
        );
        return;
    }
    let folder = Folder::new("hyperqueue", MIXED);
    folder.sweep("whole.csv", &[]);
    let (scene, output, inside) = (folder.scene(), folder.at("7.csv"), folder.at(""));
    let run =
        python(&["-c", HYPERQUEUE, env!("CARGO_BIN_EXE_vi-lab"), &scene, &output, &inside, "7"]).expect("python runs");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    assert_eq!(folder.merge(&["7.csv.part"], "merged.csv"), (Some(0), String::new()));
    assert!(folder.read("merged.csv") == folder.read("whole.csv"));
    println!("tested with HyperQueue: seven tasks");
}

/// Steps that are too long reach the end of their run all the same: the summary says so.
#[test]
fn runs_whose_steps_are_too_long_are_counted() {
    let scene = |h: &str| {
        format!(
            "system = \"kepler\"\nmethod = \"gauss\"\nh = {h}\nuntil = 6.0\n[sweep]\nover = [{{ name = \"v_y\", values = [0.8, 0.9, 2.0] }}]\n"
        )
    };
    for (h, warning) in [("0.1", "; warning: 2 have a step with an error above 0.001, see `step_error`"), ("0.01", "")]
    {
        let folder = Folder::new(&format!("accuracy-{h}"), &scene(h));
        let (status, summary, errors) = lab(&["sweep", &folder.scene(), "-o", &folder.at("runs.csv")]);
        assert_eq!(status, Some(0), "{errors}");
        assert!(summary.trim_end().ends_with(&format!("3 runs, all reached their end{warning}")), "{summary}");
        let text = folder.text("runs.csv");
        assert!(text.contains("\nitem,v_y,ending,steps,step_error,end_t,"), "{text}");
        let errors: Vec<f64> = text
            .lines()
            .filter(|line| line.contains("reached its end"))
            .map(|line| line.split(',').nth(4).and_then(|entry| entry.parse().ok()).expect("a number"))
            .collect();
        println!("h = {h}: {errors:?}");
        assert!(errors.len() == 3 && errors.iter().all(|error| *error > 0.0), "{text}");
    }
}
