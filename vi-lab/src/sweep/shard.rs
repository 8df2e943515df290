//! Which part of a sweep this process does.
//!
//! In: `--shard I/N` or `--shard N`, and what a cluster's scheduler says in the environment. Out: a [`Shard`], or none for the whole. Shards are
//! numbered from 0, as the tasks of an array are; the runs of one stand next to each other, so that parts put together in their order
//! are the whole.

use core::fmt;
use core::ops::Range;
use serde::{Deserialize, Serialize};
use vi_report::failure::Failure;

/// One of some parts of equal size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Shard {
    /// Which one, from 0 on.
    pub(super) index: u64,
    /// How many there are.
    pub(super) count: u64,
}

impl Shard {
    /// All of it.
    pub(super) const WHOLE: Self = Self { index: 0, count: 1 };

    /// The shard that is asked for, or that of the array task which this process is.
    ///
    /// # Errors
    /// [`Failure::Input`] for a shard that there is not, and where the environment does not say how many there are, or which one this is.
    pub(super) fn of(asked: Option<&str>, variable: impl Fn(&str) -> Option<String>) -> Result<Option<Self>, Failure> {
        let asked = asked.map(Asked::parse).transpose().map_err(Failure::Input)?;
        let shard = match asked {
            Some(Asked { index: Some(index), count }) => Ok(Some(Self { index, count })),
            Some(Asked { index: None, count }) => task(&variable).and_then(|index| match index {
                Some(index) => Ok(Some(Self { index, count })),
                None => Err(format!(
                    "`--shard {count}` is for a task of an array, whose number HQ_TASK_ID or SLURM_ARRAY_TASK_ID tells; \
                     elsewhere write --shard I/{count}"
                )),
            }),
            None => scheduled(&variable),
        };
        match shard.map_err(Failure::Input)? {
            Some(Self { index, count }) if index >= count => Err(Failure::Input(match count {
                0 => "there must be at least one shard".to_owned(),
                _ => format!(
                    "there is no shard {index}/{count}: they are numbered from 0/{count} to {}/{count}",
                    count - 1
                ),
            })),
            shard => Ok(shard),
        }
    }

    /// The items of this shard, of so many.
    pub(super) fn items(self, all: u64) -> Range<u64> {
        let begin =
            |index: u64| u64::try_from(u128::from(all) * u128::from(index) / u128::from(self.count)).unwrap_or(all);
        begin(self.index)..begin(self.index + 1)
    }
}

/// A number of the environment; none where it is not set.
fn number(variable: impl Fn(&str) -> Option<String>, name: &str) -> Result<Option<u64>, String> {
    let Some(text) = variable(name) else { return Ok(None) };
    let number = text.trim().parse().map(Some);
    number.map_err(|_| {
        format!(
            "{name} is `{text}`, which is no number of a scheduler; write --shard I/N, or unset {name} for the whole"
        )
    })
}

/// Which task of an array this process is.
fn task(variable: &impl Fn(&str) -> Option<String>) -> Result<Option<u64>, String> {
    let task = number(variable, "HQ_TASK_ID")?;
    if task.is_some() { Ok(task) } else { number(variable, "SLURM_ARRAY_TASK_ID") }
}

/// The shard that a scheduler says; none where there is no scheduler.
fn scheduled(variable: &impl Fn(&str) -> Option<String>) -> Result<Option<Shard>, String> {
    match number(variable, "HQ_TASK_ID")? {
        Some(0) => Ok(None),
        Some(task) => Err(format!(
            "this is task {task} of HyperQueue, which does not say how many there are; write --shard N, and number \
             the tasks from 0 to N - 1"
        )),
        None => slurm(|name| number(variable, name)),
    }
}

/// The shard of a task of a Slurm array; none where there is no array.
fn slurm(number: impl Fn(&str) -> Result<Option<u64>, String>) -> Result<Option<Shard>, String> {
    let (Some(task), Some(count)) = (number("SLURM_ARRAY_TASK_ID")?, number("SLURM_ARRAY_TASK_COUNT")?) else {
        return Ok(None);
    };
    let first = number("SLURM_ARRAY_TASK_MIN")?.unwrap_or(0);
    let last = number("SLURM_ARRAY_TASK_MAX")?.unwrap_or(first.saturating_add(count.saturating_sub(1)));
    // A task that is run again alone is an array of one.
    if first > 1 || (last - first.min(last)).checked_add(1) != Some(count) || task < first {
        return Err(format!(
            "the tasks of this array are not all of 0 to N - 1; to run some of them again write --shard N, which is then \
             shard {task}/N"
        ));
    }
    Ok(Some(Shard { index: task - first, count }))
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

/// What stands behind `--shard`.
struct Asked {
    index: Option<u64>,
    count: u64,
}

impl Asked {
    /// What stands there.
    ///
    /// # Errors
    /// What it must be.
    fn parse(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse().ok();
        let (index, count) = match text.split_once('/') {
            Some((index, count)) => (number(index).map(Some), number(count)),
            None => (Some(None), number(text)),
        };
        index.zip(count).map(|(index, count)| Self { index, count }).ok_or_else(|| {
            format!("`--shard {text}` must be I/N, or N in a task of an array: two whole numbers, I from 0 to N - 1")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shard(asked: Option<&str>, variables: &[(&str, u64)]) -> Result<Option<(u64, u64)>, String> {
        let variable =
            |name: &str| variables.iter().find(|(known, _)| *known == name).map(|(_, value)| value.to_string());
        let shard = Shard::of(asked, variable).map_err(|failure| failure.to_string())?;
        Ok(shard.map(|shard| (shard.index, shard.count)))
    }

    #[test]
    fn the_option_goes_before_the_environment() {
        let slurm = [
            ("SLURM_ARRAY_TASK_ID", 7),
            ("SLURM_ARRAY_TASK_COUNT", 7),
            ("SLURM_ARRAY_TASK_MIN", 1),
            ("SLURM_ARRAY_TASK_MAX", 7),
        ];
        assert_eq!(shard(None, &[]), Ok(None));
        assert_eq!(shard(Some("2/5"), &slurm), Ok(Some((2, 5))));
        assert_eq!(shard(None, &slurm), Ok(Some((6, 7))));
        assert_eq!(shard(None, &slurm[..2]).map_err(|_| ()), Err(()));
        assert_eq!(shard(Some("9"), &slurm), Ok(Some((7, 9))));
        let from_zero = [("SLURM_ARRAY_TASK_ID", 6), ("SLURM_ARRAY_TASK_COUNT", 7), ("SLURM_ARRAY_TASK_MIN", 0)];
        assert_eq!(shard(None, &from_zero), Ok(Some((6, 7))));
        // HyperQueue inside an allocation of Slurm; a job that is no array has the task 0.
        assert_eq!(shard(Some("8"), &[slurm.as_slice(), &[("HQ_TASK_ID", 3)]].concat()), Ok(Some((3, 8))));
        assert_eq!(shard(None, &[("HQ_TASK_ID", 0)]), Ok(None));
    }

    #[test]
    fn wrong_shards_are_told() {
        let one_again = [("SLURM_ARRAY_TASK_ID", 3), ("SLURM_ARRAY_TASK_COUNT", 1), ("SLURM_ARRAY_TASK_MIN", 3)];
        for (asked, variables, message) in [
            (Some("7/7"), &[][..], "there is no shard 7/7: they are numbered from 0/7 to 6/7"),
            (Some("0/0"), &[], "there must be at least one shard"),
            (
                Some("-1/7"),
                &[],
                "`--shard -1/7` must be I/N, or N in a task of an array: two whole numbers, I from 0 to N - 1",
            ),
            (
                Some("7"),
                &[],
                "`--shard 7` is for a task of an array, whose number HQ_TASK_ID or SLURM_ARRAY_TASK_ID tells; elsewhere \
                 write --shard I/7",
            ),
            (
                None,
                &[("HQ_TASK_ID", 3)],
                "this is task 3 of HyperQueue, which does not say how many there are; write --shard N, and number the tasks \
                 from 0 to N - 1",
            ),
            (
                None,
                &one_again,
                "the tasks of this array are not all of 0 to N - 1; to run some of them again write --shard N, which is then \
                 shard 3/N",
            ),
        ] {
            assert_eq!(shard(asked, variables), Err(message.to_owned()));
        }
    }

    #[test]
    fn a_task_that_is_no_number_is_told() {
        for name in ["SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "HQ_TASK_ID"] {
            let variable = |asked: &str| match asked {
                asked if asked == name => Some("x".to_owned()),
                "SLURM_ARRAY_TASK_ID" | "SLURM_ARRAY_TASK_COUNT" => Some("3".to_owned()),
                _ => None,
            };
            let message = Shard::of(None, variable).expect_err("no number").to_string();
            let expected = format!(
                "{name} is `x`, which is no number of a scheduler; write --shard I/N, or unset {name} for the whole"
            );
            assert_eq!(message, expected);
            assert!(Shard::of(Some("2/5"), variable).is_ok(), "{name}");
        }
    }

    #[test]
    fn shards_cover_all_items_once() {
        for (all, count) in [(0, 3), (5, 7), (12, 1), (100, 7), (u64::MAX >> 11, 1000)] {
            let ranges = (0..count).map(|index| Shard { index, count }.items(all));
            let end = ranges.fold(0, |end, range| {
                assert!(range.start == end && range.end >= end && range.end - end <= all / count + 1);
                range.end
            });
            assert_eq!(end, all);
        }
    }
}
