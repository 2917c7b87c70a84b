//! What a batch scheduler says in the environment: which shard this is, and how many threads it has.

use std::num::NonZero;
use std::str::FromStr;

use super::exit::Failure;
use crate::population::table::Shard;

/// `--shard`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShardArgument {
    /// As the environment says.
    Auto,
    /// As written.
    Given(Shard),
}

impl FromStr for ShardArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "auto" {
            return Ok(Self::Auto);
        }
        let numbers = text.split_once('/').and_then(|(number, count)| {
            Some(Shard {
                number: number.parse().ok()?,
                count: count.parse().ok()?,
            })
        });
        numbers
            .filter(|shard| (1..=shard.count).contains(&shard.number))
            .map(Self::Given)
            .ok_or_else(|| "accepted: k/n with k from 1 to n, like 3/8, or auto".to_owned())
    }
}

impl ShardArgument {
    /// The shard that is meant.
    pub(super) fn shard(self) -> Result<Shard, Failure> {
        match self {
            Self::Given(shard) => Ok(shard),
            Self::Auto => shard_of(&|name| std::env::var(name).ok()).map_err(Failure::usage),
        }
    }
}

/// One task of an array: the variables that hold its index, and the first index and the last, or the
/// number of tasks.
struct ArrayVariables {
    index: &'static str,
    first: Result<&'static str, u32>,
    last: Option<&'static str>,
    count: &'static str,
}

/// Number of shards where the scheduler does not say how many tasks its array has.
const COUNT: &str = "BLISK_SHARD_COUNT";

/// Generic, Slurm, Grid Engine, LSF, PBS Professional, Torque, Kubernetes indexed jobs.
const ARRAYS: [ArrayVariables; 7] = [
    ArrayVariables {
        index: "BLISK_SHARD_INDEX",
        first: Err(1),
        last: None,
        count: COUNT,
    },
    ArrayVariables {
        index: "SLURM_ARRAY_TASK_ID",
        first: Ok("SLURM_ARRAY_TASK_MIN"),
        last: Some("SLURM_ARRAY_TASK_MAX"),
        count: "SLURM_ARRAY_TASK_COUNT",
    },
    ArrayVariables {
        index: "SGE_TASK_ID",
        first: Ok("SGE_TASK_FIRST"),
        last: Some("SGE_TASK_LAST"),
        count: COUNT,
    },
    ArrayVariables {
        index: "LSB_JOBINDEX",
        first: Err(1),
        last: Some("LSB_JOBINDEX_END"),
        count: COUNT,
    },
    ArrayVariables {
        index: "PBS_ARRAY_INDEX",
        first: Err(1),
        last: None,
        count: COUNT,
    },
    ArrayVariables {
        index: "PBS_ARRAYID",
        first: Err(1),
        last: None,
        count: COUNT,
    },
    ArrayVariables {
        index: "JOB_COMPLETION_INDEX",
        first: Err(0),
        last: None,
        count: COUNT,
    },
];

/// The shard of the first array that `variable` knows a task of.
fn shard_of(variable: &dyn Fn(&str) -> Option<String>) -> Result<Shard, String> {
    let number = |name: &str| -> Result<Option<u32>, String> {
        let Some(text) = variable(name).filter(|text| !text.is_empty()) else {
            return Ok(None);
        };
        let number = text.trim().parse();
        number
            .map(Some)
            .map_err(|_| format!("{name} = {text} is no number of a task"))
    };
    for array in &ARRAYS {
        // Outside of an array Grid Engine says "undefined" and LSF says 0.
        let index = match (array.index, number(array.index)) {
            ("SGE_TASK_ID", Err(_)) | ("LSB_JOBINDEX", Ok(Some(0))) => None,
            (_, index) => index?,
        };
        let Some(index) = index else { continue };
        let first = match array.first {
            Ok(name) => number(name)?.unwrap_or(1),
            Err(first) => first,
        };
        let last = match array.last {
            Some(name) => number(name)?,
            None => None,
        };
        let of_range = last.map(|last| (last + 1).saturating_sub(first));
        let count = number(COUNT)?.or(number(array.count)?).or(of_range);
        let Some(count) = count else {
            return Err(format!(
                "{} = {index}, and nothing says how many tasks there are: set {COUNT}, or give --shard k/n",
                array.index
            ));
        };
        // An array that was submitted again in part has gaps.
        if array.count != COUNT
            && number(COUNT)?.is_none()
            && of_range.is_some_and(|all| all != count)
        {
            return Err(format!(
                "the array has {count} tasks between {first} and {}: give --shard k/n, or set {COUNT}",
                last.unwrap_or_default()
            ));
        }
        let shard = Shard {
            number: (index + 1).saturating_sub(first),
            count,
        };
        return if (1..=count).contains(&shard.number) {
            Ok(shard)
        } else {
            Err(format!("{} = {index} is no task of {count}", array.index))
        };
    }
    Err("--shard without a value is for a task of an array (Slurm, PBS, LSF, Grid Engine, Kubernetes); elsewhere give --shard k/n".to_owned())
}

/// Variables that hold the number of processors of this task.
const PROCESSORS: [&str; 6] = [
    "SLURM_CPUS_PER_TASK",
    "SLURM_CPUS_ON_NODE",
    "NCPUS",
    "PBS_NP",
    "LSB_DJOB_NUMPROC",
    "NSLOTS",
];

/// Threads as asked for; else what the scheduler gave this task; else all processors there are.
#[must_use]
pub fn threads(asked: Option<u16>) -> usize {
    let scheduled = || {
        PROCESSORS
            .iter()
            .find_map(|name| std::env::var(name).ok()?.trim().parse::<usize>().ok())
            .filter(|&threads| threads > 0)
    };
    asked
        .map(usize::from)
        .or_else(scheduled)
        .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, NonZero::get))
}

#[cfg(test)]
mod tests {
    use super::{Shard, ShardArgument, shard_of};

    fn of(variables: &[(&str, &str)]) -> Result<(u32, u32), String> {
        let variable = |name: &str| {
            let found = variables.iter().find(|(known, _)| *known == name);
            found.map(|(_, value)| (*value).to_owned())
        };
        shard_of(&variable).map(|shard| (shard.number, shard.count))
    }

    #[test]
    fn every_scheduler_says_which_shard_this_is() {
        let slurm = [
            ("SLURM_ARRAY_TASK_ID", "5"),
            ("SLURM_ARRAY_TASK_MIN", "0"),
            ("SLURM_ARRAY_TASK_MAX", "7"),
            ("SLURM_ARRAY_TASK_COUNT", "8"),
        ];
        assert_eq!(of(&slurm), Ok((6, 8)));
        let count = ("BLISK_SHARD_COUNT", "4");
        assert_eq!(of(&[("PBS_ARRAY_INDEX", "4"), count]), Ok((4, 4)));
        assert_eq!(of(&[("JOB_COMPLETION_INDEX", "0"), count]), Ok((1, 4)));
        assert_eq!(of(&[("BLISK_SHARD_INDEX", "2"), count]), Ok((2, 4)));
        let engine = [
            ("SGE_TASK_ID", "3"),
            ("SGE_TASK_FIRST", "2"),
            ("SGE_TASK_LAST", "5"),
        ];
        assert_eq!(of(&engine), Ok((2, 4)));
        let lsf = [("LSB_JOBINDEX", "3"), ("LSB_JOBINDEX_END", "9")];
        assert_eq!(of(&lsf), Ok((3, 9)));
    }

    #[test]
    fn what_does_not_name_a_shard_is_refused() {
        assert!(of(&[]).is_err_and(|error| error.contains("--shard k/n")));
        let alone = [("PBS_ARRAY_INDEX", "4")];
        assert!(of(&alone).is_err_and(|error| error.contains("BLISK_SHARD_COUNT")));
        let again = [
            ("SLURM_ARRAY_TASK_ID", "7"),
            ("SLURM_ARRAY_TASK_MIN", "3"),
            ("SLURM_ARRAY_TASK_MAX", "7"),
            ("SLURM_ARRAY_TASK_COUNT", "2"),
        ];
        assert!(of(&again).is_err_and(|error| error.contains("2 tasks between 3 and 7")));
        assert!(of(&[("BLISK_SHARD_INDEX", "5"), ("BLISK_SHARD_COUNT", "4")]).is_err());
        assert!(of(&[("SGE_TASK_ID", "undefined"), ("LSB_JOBINDEX", "0")]).is_err());
        for text in ["0/3", "4/3", "3", "a/b", "1/0", ""] {
            assert!(text.parse::<ShardArgument>().is_err(), "{text}");
        }
        let shard = Shard {
            number: 3,
            count: 8,
        };
        assert_eq!("3/8".parse(), Ok(ShardArgument::Given(shard)));
    }
}
