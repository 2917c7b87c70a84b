//! Values of a study file that are of one type or another, as they are written.

use std::fmt;
use std::marker::PhantomData;

use serde::Serialize;
use serde::de::{self, Deserialize, Deserializer, IgnoredAny, SeqAccess, Unexpected, Visitor};

/// A number of newtons or the name of a linear limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(in crate::study) enum NumberOrName {
    Number(f64),
    Name(String),
}

/// One number or a list.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(in crate::study) enum OneOrMore {
    One(f64),
    List(Vec<f64>),
}

/// A name like `"auto"`, or a list of what it stands for; what is accepted is said by [`Listed`].
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(in crate::study) enum NameOrList<T> {
    Name(String),
    List(Vec<T>),
}

/// What stands in a list that a name may stand for.
pub(in crate::study) trait Listed {
    /// A name or a list of these, in words.
    const EXPECTED: &str;
}

/// Harmonics.
impl Listed for u32 {
    const EXPECTED: &str = "\"auto\" or a list of harmonics like [1, 3]";
}

/// Frequencies, Hz.
impl Listed for f64 {
    const EXPECTED: &str = "\"auto\" or two frequencies like [540.0, 580.0]";
}

/// A value of one type or another: each of these makes it, or none where that type is not accepted.
trait OneOf: Sized {
    /// What is accepted, in words.
    const EXPECTED: &str;
    type Item;

    fn of_number(_number: f64) -> Option<Self> {
        None
    }

    fn of_name(_name: &str) -> Option<Self> {
        None
    }

    fn of_list(_list: Vec<Self::Item>) -> Option<Self> {
        None
    }
}

impl OneOf for NumberOrName {
    const EXPECTED: &str = "a number of newtons of at least 0, \"stuck\", \"slide\" or \"free\"";
    type Item = IgnoredAny;

    fn of_number(number: f64) -> Option<Self> {
        Some(Self::Number(number))
    }

    fn of_name(name: &str) -> Option<Self> {
        Some(Self::Name(name.to_owned()))
    }
}

impl OneOf for OneOrMore {
    const EXPECTED: &str = "a number or a list of numbers";
    type Item = f64;

    fn of_number(number: f64) -> Option<Self> {
        Some(Self::One(number))
    }

    fn of_list(list: Vec<f64>) -> Option<Self> {
        Some(Self::List(list))
    }
}

impl<T: Listed> OneOf for NameOrList<T> {
    const EXPECTED: &str = T::EXPECTED;
    type Item = T;

    fn of_name(name: &str) -> Option<Self> {
        Some(Self::Name(name.to_owned()))
    }

    fn of_list(list: Vec<T>) -> Option<Self> {
        Some(Self::List(list))
    }
}

struct OneOfVisitor<V>(PhantomData<V>);

impl<'de, V: OneOf<Item: Deserialize<'de>>> Visitor<'de> for OneOfVisitor<V> {
    type Value = V;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(V::EXPECTED)
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<V, E> {
        let refused = || E::invalid_type(Unexpected::Float(number), &self);
        V::of_number(number).ok_or_else(refused)
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<V, E> {
        self.visit_f64(number as f64)
    }

    fn visit_u64<E: de::Error>(self, number: u64) -> Result<V, E> {
        self.visit_f64(number as f64)
    }

    fn visit_str<E: de::Error>(self, name: &str) -> Result<V, E> {
        let refused = || E::invalid_type(Unexpected::Str(name), &self);
        V::of_name(name).ok_or_else(refused)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<V, A::Error> {
        let mut list = Vec::new();
        while let Some(element) = elements.next_element()? {
            list.push(element);
        }
        let refused = || de::Error::invalid_type(Unexpected::Seq, &self);
        V::of_list(list).ok_or_else(refused)
    }
}

impl<'de> Deserialize<'de> for NumberOrName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OneOfVisitor(PhantomData))
    }
}

impl<'de> Deserialize<'de> for OneOrMore {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OneOfVisitor(PhantomData))
    }
}

impl<'de, T: Listed + Deserialize<'de>> Deserialize<'de> for NameOrList<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OneOfVisitor(PhantomData))
    }
}
