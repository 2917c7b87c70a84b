//! A table of a study file whose keys are fields of options: one declaration reads a key, judges its value and writes it back.

use super::written::NameOrList;
use crate::input::Value;
use crate::model::reduction::Basis;
use crate::population::table::Compression;
use crate::response::forced_response::{
    AmplitudeMeasure, FrequencyBand, Harmonics, RowsBeyondTolerance, SearchHarmonics,
};

/// A table of a study file whose keys are fields of options.
pub(in crate::study) trait OptionsTable: Sized {
    /// The options.
    type Options;

    /// Puts what the table states into `options`; the names of the keys whose values are not accepted.
    fn put_into(self, options: &mut Self::Options) -> Vec<&'static str>;

    /// The table that states all of `options`.
    fn of(options: &Self::Options) -> Self;
}

/// A value of an option, and how a study file has it.
pub(in crate::study) trait InFile: Sized {
    /// Type in the file.
    type Written;

    /// The value, and whether it is `accepted`.
    fn read(written: Self::Written, accepted: &Value) -> (Self, bool);

    /// As the file has it; none where the key is left out.
    fn written(&self) -> Option<Self::Written>;
}

/// Declares a table as [`toml_table`](crate::input::toml_table) does, each key with the type of the field of the options that has its
/// name, or the name after `as`.
macro_rules! options_table {
    (
        $(#[$meta:meta])*
        $vis:vis struct $Table:ident of $Options:ty {
            $( $name:ident $(as $field:ident)?: $type:ty = $key:expr, )*
        }
    ) => {
        crate::input::toml_table! {
            $(#[$meta])*
            $vis struct $Table {
                $( $name: <$type as crate::study::keys::options_table::InFile>::Written = $key, )*
            }
        }

        impl crate::study::keys::options_table::OptionsTable for $Table {
            type Options = $Options;

            fn put_into(self, options: &mut $Options) -> Vec<&'static str> {
                use crate::study::keys::options_table::{InFile, field};
                let mut refused = Vec::new();
                $(
                    if let Some(written) = self.$name {
                        const KEY: crate::input::Entry = $key;
                        let (value, is_accepted) = <$type>::read(written, &KEY.value);
                        field!(options $name $($field)?) = value;
                        if !is_accepted {
                            refused.push(stringify!($name));
                        }
                    }
                )*
                refused
            }

            fn of(options: &$Options) -> Self {
                use crate::study::keys::options_table::{InFile, field};
                Self { $( $name: field!(options $name $($field)?).written(), )* }
            }
        }
    };
}

/// The field of the options that a key is.
macro_rules! field {
    ($options:ident $name:ident) => {
        $options.$name
    };
    ($options:ident $name:ident $field:ident) => {
        $options.$field
    };
}

pub(super) use {field, options_table};

/// Values that a file has as they are: their names are all that it can hold.
macro_rules! accepted_as_they_are {
    ($($type:ty),*) => {$(
        impl InFile for $type {
            type Written = Self;

            fn read(written: Self, _: &Value) -> (Self, bool) {
                (written, true)
            }

            fn written(&self) -> Option<Self> {
                Some(*self)
            }
        }
    )*};
}

accepted_as_they_are!(
    bool,
    Basis,
    RowsBeyondTolerance,
    AmplitudeMeasure,
    Compression
);

impl InFile for f64 {
    type Written = Self;

    fn read(written: Self, accepted: &Value) -> (Self, bool) {
        (written, accepted.holds(written))
    }

    fn written(&self) -> Option<Self> {
        Some(*self)
    }
}

impl InFile for usize {
    type Written = Self;

    fn read(written: Self, accepted: &Value) -> (Self, bool) {
        (written, accepted.holds(written as f64))
    }

    fn written(&self) -> Option<Self> {
        Some(*self)
    }
}

impl InFile for u32 {
    type Written = u64;

    fn read(written: u64, accepted: &Value) -> (Self, bool) {
        (written as Self, accepted.holds(written as f64))
    }

    fn written(&self) -> Option<u64> {
        Some(u64::from(*self))
    }
}

impl<T: InFile> InFile for Option<T> {
    type Written = T::Written;

    fn read(written: T::Written, accepted: &Value) -> (Self, bool) {
        let (value, is_accepted) = T::read(written, accepted);
        (Some(value), is_accepted)
    }

    fn written(&self) -> Option<T::Written> {
        self.as_ref().and_then(T::written)
    }
}

/// Highest harmonic accepted.
const MAX_HARMONIC: u32 = 100;

/// Whether harmonics are a set that has the fundamental.
fn is_set(harmonics: &[u32]) -> bool {
    harmonics.contains(&1)
        && harmonics.is_sorted_by(|a, b| a < b)
        && harmonics.last() <= Some(&MAX_HARMONIC)
}

/// A refused set is [`Self::Auto`].
impl InFile for Harmonics {
    type Written = NameOrList<u32>;

    fn read(written: Self::Written, _: &Value) -> (Self, bool) {
        match written {
            NameOrList::Name(name) => (Self::Auto, name == "auto"),
            NameOrList::List(set) if is_set(&set) => (Self::Set(set), true),
            NameOrList::List(_) => (Self::Auto, false),
        }
    }

    fn written(&self) -> Option<Self::Written> {
        Some(match self {
            Self::Auto => NameOrList::Name("auto".to_owned()),
            Self::Set(set) => NameOrList::List(set.clone()),
        })
    }
}

/// A refused set is [`Self::Auto`].
impl InFile for SearchHarmonics {
    type Written = NameOrList<u32>;

    fn read(written: Self::Written, _: &Value) -> (Self, bool) {
        match written {
            NameOrList::Name(name) if name == "all" => (Self::All, true),
            NameOrList::Name(name) => (Self::Auto, name == "auto"),
            NameOrList::List(set) if is_set(&set) => (Self::Set(set), true),
            NameOrList::List(_) => (Self::Auto, false),
        }
    }

    fn written(&self) -> Option<Self::Written> {
        Some(match self {
            Self::Auto => NameOrList::Name("auto".to_owned()),
            Self::All => NameOrList::Name("all".to_owned()),
            Self::Set(set) => NameOrList::List(set.clone()),
        })
    }
}

/// A refused band is [`Self::Auto`].
impl InFile for FrequencyBand {
    type Written = NameOrList<f64>;

    fn read(written: Self::Written, _: &Value) -> (Self, bool) {
        match written {
            NameOrList::Name(name) => (Self::Auto, name == "auto"),
            NameOrList::List(ends) => match ends[..] {
                [start_hz, stop_hz]
                    if start_hz > 0.0 && start_hz < stop_hz && stop_hz.is_finite() =>
                {
                    (Self::Fixed { start_hz, stop_hz }, true)
                }
                _ => (Self::Auto, false),
            },
        }
    }

    fn written(&self) -> Option<Self::Written> {
        Some(match *self {
            Self::Auto => NameOrList::Name("auto".to_owned()),
            Self::Fixed { start_hz, stop_hz } => NameOrList::List(vec![start_hz, stop_hz]),
        })
    }
}
