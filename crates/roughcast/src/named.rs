//! Enums whose variants have a name, which the command line, the files' metadata and Python share.

/// Declares an enum with `ALL`, `name()`, `Display` and `FromStr` from one list of variants. With the feature `serde`
/// it is serialized by name. All crates of this workspace use it, so that all names a user types behave alike.
#[macro_export]
macro_rules! named_enum {
    (
        $(#[$meta:meta])*
        pub enum $type:ident: $what:literal {
            $( $(#[$variant_meta:meta])* $variant:ident = $name:literal ),+ $(,)?
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $type { $( $(#[$variant_meta])* $variant ),+ }

        impl $type {
            /// Every variant, in the order of declaration.
            pub const ALL: &'static [Self] = &[ $( Self::$variant ),+ ];

            /// The name used by the command line, the metadata of files and Python.
            pub const fn name(self) -> &'static str {
                match self { $( Self::$variant => $name ),+ }
            }
        }

        impl $crate::Named for $type {
            fn all() -> &'static [Self] {
                Self::ALL
            }

            fn name(self) -> &'static str {
                self.name()
            }
        }

        $crate::__serde_by_name!($type);

        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.name())
            }
        }

        impl std::str::FromStr for $type {
            type Err = $crate::UnknownName;
            fn from_str(name: &str) -> Result<Self, Self::Err> {
                Self::ALL.iter().copied().find(|v| v.name() == name).ok_or_else(|| $crate::UnknownName {
                    what: $what,
                    got: name.to_owned(),
                    known: Self::ALL.iter().map(|v| v.name()).collect::<Vec<_>>().join(", "),
                })
            }
        }
    };
}

/// Serializes a named enum by name.
#[cfg(feature = "serde")]
#[doc(hidden)]
#[macro_export]
macro_rules! __serde_by_name {
    ($type:ident) => {
        impl $crate::__serde::Serialize for $type {
            fn serialize<S: $crate::__serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }

        impl<'de> $crate::__serde::Deserialize<'de> for $type {
            fn deserialize<D: $crate::__serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let name = <String as $crate::__serde::Deserialize>::deserialize(deserializer)?;
                name.parse().map_err($crate::__serde::de::Error::custom)
            }
        }
    };
}

/// Does nothing: the feature `serde` is off.
#[cfg(not(feature = "serde"))]
#[doc(hidden)]
#[macro_export]
macro_rules! __serde_by_name {
    ($type:ident) => {};
}

/// An enum whose variants have names.
pub trait Named: Copy + 'static {
    /// Every variant, in the order of declaration.
    fn all() -> &'static [Self];

    /// The name used by the command line, the metadata of files and Python.
    fn name(self) -> &'static str;
}

/// A name that matches no variant.
#[derive(Clone, Debug, PartialEq, Eq, Hash, thiserror::Error)]
#[error("no {what} is called '{got}': choose one of {known}")]
pub struct UnknownName {
    /// The kind of item that was requested.
    pub what: &'static str,
    /// The name given.
    pub got: String,
    /// The known names.
    pub known: String,
}

pub(crate) use named_enum;
