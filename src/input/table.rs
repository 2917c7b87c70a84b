//! A table of a TOML file, declared once: what a file may say in it, and what each key accepts and means.

/// Declares a table: a struct with an optional field for each key, which reads the table and writes it, and `KEYS`, what each accepts
/// and means. An unknown key is refused with the names of the fields in their order.
///
/// ```text
/// toml_table! {
///     /// The table `[stop]`.
///     pub struct StopTable {
///         percentile: f64 = key(Number(Range::above(0.0).below(100.0)), REQUIRED, "in percent"),
///     }
/// }
/// ```
macro_rules! toml_table {
    (
        $(#[$meta:meta])*
        $vis:vis struct $Table:ident {
            $( $name:ident: $type:ty = $key:expr, )*
        }
    ) => {
        $(#[$meta])*
        #[derive(Debug, Default, serde::Deserialize, serde::Serialize)]
        #[serde(deny_unknown_fields)]
        $vis struct $Table {
            $(
                #[serde(skip_serializing_if = "Option::is_none")]
                pub $name: Option<$type>,
            )*
        }

        impl $Table {
            /// What each key accepts and means.
            $vis const KEYS: &'static [$crate::input::Entry] = &[$( $key.named(stringify!($name)) ),*];
        }
    };
}

pub(crate) use toml_table;
