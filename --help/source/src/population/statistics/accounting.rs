//! How many rows ended in which status: the only count of rows that any output shows.

use std::collections::BTreeMap;

use serde::Serialize;

use super::proportion_upper_bound;
use crate::response::harmonic_balance::Status;

/// Rows by status; `planned = ok + failed` by construction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Accounting {
    counts: [u64; Status::ALL.len()],
}

impl Accounting {
    /// Counts one row.
    pub fn add(&mut self, status: Status) {
        if let Some(place) = Status::ALL.iter().position(|&known| known == status) {
            self.counts[place] += 1;
        }
    }

    /// Adds the counts of `other`.
    pub fn merge(&mut self, other: &Self) {
        for (count, more) in self.counts.iter_mut().zip(other.counts) {
            *count += more;
        }
    }

    /// Rows that ended in `status`.
    #[must_use]
    pub fn count(&self, status: Status) -> u64 {
        Status::ALL
            .iter()
            .position(|&known| known == status)
            .map_or(0, |place| self.counts[place])
    }

    /// All rows.
    #[must_use]
    pub fn planned(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Rows that are `ok`.
    #[must_use]
    pub fn ok(&self) -> u64 {
        self.count(Status::Ok)
    }

    /// Rows of every status but `ok`.
    #[must_use]
    pub fn failed(&self) -> u64 {
        self.planned() - self.ok()
    }

    /// Upper bound on the share of failed rows in the population, one-sided 95 %, exact (Clopper &
    /// Pearson 1934); none without rows.
    #[must_use]
    pub fn failed_share_upper_bound(&self) -> Option<f64> {
        (self.planned() > 0).then(|| proportion_upper_bound(self.failed(), self.planned()))
    }

    /// Counts by name of the status, those that are not zero.
    #[must_use]
    pub fn by_status(&self) -> BTreeMap<&'static str, u64> {
        Status::ALL
            .iter()
            .zip(self.counts)
            .filter(|&(_, count)| count > 0)
            .map(|(status, count)| (status.name(), count))
            .collect()
    }
}

impl FromIterator<Status> for Accounting {
    fn from_iter<I: IntoIterator<Item = Status>>(statuses: I) -> Self {
        let mut accounting = Self::default();
        for status in statuses {
            accounting.add(status);
        }
        accounting
    }
}

impl Serialize for Accounting {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct;
        let mut fields = serializer.serialize_struct("Accounting", 5)?;
        fields.serialize_field("planned", &self.planned())?;
        fields.serialize_field("ok", &self.ok())?;
        fields.serialize_field("failed", &self.failed())?;
        fields.serialize_field("by_status", &self.by_status())?;
        fields.serialize_field("failed_share_upper_bound", &self.failed_share_upper_bound())?;
        fields.end()
    }
}
