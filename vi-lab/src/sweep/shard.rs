//! The part of a sweep for this process: `--shard I/N` or `--shard N`, or the environment of a cluster scheduler.
//!
//! Shards are numbered from 0, like the tasks of an array. The chunks of a shard are consecutive.

use core::ops::Range;
use vi_report::failure::Failure;

/// One of `count` parts of equal size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shard {
    /// Index of the shard, from 0.
    pub(super) index: u64,
    pub(super) count: u64,
}

/// A number in the environment; `None` if it is not set.
type Number<'a> = &'a dyn Fn(&str) -> Result<Option<u64>, String>;

impl Shard {
    /// The complete sweep.
    pub(super) const WHOLE: Self = Self { index: 0, count: 1 };

    /// The requested shard, or the shard of this array task; `None` without either.
    ///
    /// # Errors
    /// [`Failure::Input`] if there is no such shard, or the environment does not determine it.
    pub(super) fn of(asked: Option<&str>, variable: impl Fn(&str) -> Option<String>) -> Result<Option<Self>, Failure> {
        let number = |name: &str| {
            let Some(text) = variable(name) else { return Ok(None) };
            let remedy = format!("write --shard I/N, or unset {name} to compute all");
            let number = text.trim().parse().map(Some);
            number.map_err(|_| format!("{name} is `{text}`, which is not a task number; {remedy}"))
        };
        let shard = asked.map_or_else(|| scheduled(&number), |text| parse(text, &number).map(Some));
        match shard.map_err(Failure::Input)? {
            Some(Self { count: 0, .. }) => Err(Failure::Input("there must be at least one shard".to_owned())),
            Some(Self { index, count }) if index >= count => Err(Failure::Input(format!(
                "there is no shard {index}/{count}: they are numbered from 0/{count} to {}/{count}",
                count - 1
            ))),
            shard => Ok(shard),
        }
    }

    /// The chunks of this shard, out of `all`.
    pub(super) fn chunks(self, all: u64) -> Range<u64> {
        let begin =
            |index: u64| u64::try_from(u128::from(all) * u128::from(index) / u128::from(self.count)).unwrap_or(all);
        begin(self.index)..begin(self.index + 1)
    }
}

/// The shard of `--shard I/N`, or of `--shard N` in an array task.
fn parse(text: &str, number: Number<'_>) -> Result<Shard, String> {
    let wrong =
        || format!("`--shard {text}` must be I/N, or N in a task of an array: two whole numbers, I from 0 to N - 1");
    let whole = |text: &str| text.trim().parse::<u64>().map_err(|_| wrong());
    if let Some((index, count)) = text.split_once('/') {
        return Ok(Shard { index: whole(index)?, count: whole(count)? });
    }
    let count = whole(text)?;
    let task = number("HQ_TASK_ID").transpose().or_else(|| number("SLURM_ARRAY_TASK_ID").transpose());
    let index = task.transpose()?.ok_or_else(|| {
        format!(
            "`--shard {count}` needs an array task with its number in HQ_TASK_ID or SLURM_ARRAY_TASK_ID; \
             elsewhere write --shard I/{count}"
        )
    })?;
    Ok(Shard { index, count })
}

/// The shard given by a scheduler; `None` outside an array of tasks.
fn scheduled(number: Number<'_>) -> Result<Option<Shard>, String> {
    match number("HQ_TASK_ID")? {
        // A job that is not an array.
        Some(0) => return Ok(None),
        Some(task) => {
            return Err(format!(
                "this is task {task} of HyperQueue, which does not report their number; write --shard N, and number \
                 the tasks from 0 to N - 1"
            ));
        }
        None => {}
    }
    let (Some(task), Some(count)) = (number("SLURM_ARRAY_TASK_ID")?, number("SLURM_ARRAY_TASK_COUNT")?) else {
        return Ok(None);
    };
    let first = number("SLURM_ARRAY_TASK_MIN")?.unwrap_or(0);
    let last = number("SLURM_ARRAY_TASK_MAX")?.unwrap_or(first.saturating_add(count.saturating_sub(1)));
    // A single task that is run again is an array of one.
    if first > 1 || (last - first.min(last)).checked_add(1) != Some(count) || task < first {
        return Err(format!(
            "the tasks of this array are not all of 0 to N - 1; to run some of them again write --shard N, which is then \
             shard {task}/N"
        ));
    }
    Ok(Some(Shard { index: task - first, count }))
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
        // HyperQueue inside an allocation of Slurm; a job that is not an array has task 0.
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
                "`--shard 7` needs an array task with its number in HQ_TASK_ID or SLURM_ARRAY_TASK_ID; elsewhere \
                 write --shard I/7",
            ),
            (
                None,
                &[("HQ_TASK_ID", 3)],
                "this is task 3 of HyperQueue, which does not report their number; write --shard N, and number the tasks \
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
            let expected =
                format!("{name} is `x`, which is not a task number; write --shard I/N, or unset {name} to compute all");
            assert_eq!(message, expected);
            assert!(Shard::of(Some("2/5"), variable).is_ok(), "{name}");
        }
    }
}
