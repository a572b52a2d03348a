//! Methods that change one field of a struct of options.

/// Defines a method `with_…` for each of the fields.
///
/// Structs of options are `#[non_exhaustive]`, so that a minor version may add a field: another crate starts from the
/// defaults and changes what it needs.
macro_rules! setters {
    ($options:ty { $($with:ident($field:ident: $of:ty),)* }) => {
        impl $options {
            $(
                #[doc = concat!("Returns this struct with [`", stringify!($field), "`](Self::", stringify!($field), ") replaced.")]
                #[must_use]
                pub fn $with(self, $field: $of) -> Self {
                    Self { $field, ..self }
                }
            )*
        }
    };
}

pub(crate) use setters;
