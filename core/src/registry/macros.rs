//! The macros by which kinds are declared and objects registered.

/// Registers one object under its name: the last lines of its file.
///
/// The first word is the type of the entry. `aliases`, `about`, `source`, `defaults` and `like` are fields of every
/// [`Entry`](crate::registry::Entry); `build` makes the object; further facts are methods of the entry's type.
///
/// ```ignore
/// register! { ProcessEntry "assign_flag_process",
///     aliases: &["AssignFlagProcess"],
///     about: "sets or unsets a flag of nodes or entities",
///     defaults: include_str!("…/configs/processes/assign_flag_process.json"),
///     build: AssignFlag::boxed,
/// }
/// ```
#[macro_export]
macro_rules! register {
    ($type:ident $name:expr, $($field:ident : $value:expr),* $(,)?) => {
        $crate::register! { @ $type $name, [] [] [] $($field: $value,)* }
    };
    (@ $type:ident $name:expr, [$($common:tt)*] [$($build:expr)?] [$($own:tt)*]) => {
        $crate::inventory::submit! {
            $type::new(
                $crate::registry::Entry { $($common)* ..$crate::registry::Entry::new($name, file!(), line!()) },
                $($build,)?
            ) $($own)*
        }
    };
    (@ $type:ident $name:expr, [$($common:tt)*] $build:tt $own:tt aliases: $value:expr, $($rest:tt)*) => {
        $crate::register! { @ $type $name, [$($common)* aliases: $value,] $build $own $($rest)* }
    };
    (@ $type:ident $name:expr, [$($common:tt)*] $build:tt $own:tt about: $value:expr, $($rest:tt)*) => {
        $crate::register! { @ $type $name, [$($common)* about: $value,] $build $own $($rest)* }
    };
    (@ $type:ident $name:expr, [$($common:tt)*] $build:tt $own:tt source: $value:expr, $($rest:tt)*) => {
        $crate::register! { @ $type $name, [$($common)* source: $value,] $build $own $($rest)* }
    };
    (@ $type:ident $name:expr, [$($common:tt)*] $build:tt $own:tt defaults: $value:expr, $($rest:tt)*) => {
        $crate::register! { @ $type $name, [$($common)* defaults: $value,] $build $own $($rest)* }
    };
    (@ $type:ident $name:expr, [$($common:tt)*] $build:tt $own:tt like: $value:expr, $($rest:tt)*) => {
        $crate::register! { @ $type $name, [$($common)* like: $value,] $build $own $($rest)* }
    };
    (@ $type:ident $name:expr, $common:tt [] $own:tt build: $value:expr, $($rest:tt)*) => {
        $crate::register! { @ $type $name, $common [$value] $own $($rest)* }
    };
    (@ $type:ident $name:expr, $common:tt $build:tt [$($own:tt)*] $field:ident: $value:expr, $($rest:tt)*) => {
        $crate::register! { @ $type $name, $common $build [$($own)* .$field($value)] $($rest)* }
    };
}

/// Registers beginnings of names that are known and not there, each with its replacement.
///
/// ```ignore
/// register_absent! { ElementEntry ["Shell", "Sprism"] => "use solid elements, three or more across the thickness" }
/// ```
#[macro_export]
macro_rules! register_absent {
    ($type:ident [$($stem:literal),+ $(,)?] => $remedy:literal) => {
        $crate::inventory::submit! { $crate::registry::Absent {
            kind: <$type as $crate::registry::Registered>::KIND, stems: &[$($stem),+], remedy: $remedy } }
    };
}

/// Declares a kind of thing that decks name: the type of its entries, the word of `zelus list`, the code of the error for an unknown
/// name, the factory of an entry, and further facts with the values they have where none is given.
///
/// ```ignore
/// registered_kind! {
///     /// A process that decks name.
///     pub struct ProcessEntry("process", "unknown-process") {
///         build: ProcessFactory;
///         /// Keys that name what every rank must have whole.
///         common: &'static [&'static str] = &[],
///     }
/// }
/// ```
#[macro_export]
macro_rules! registered_kind {
    (
        $(#[$doc:meta])*
        $vis:vis struct $type:ident($word:literal, $unknown:literal) {
            build: $build:ty;
            $($(#[$field_doc:meta])* $field:ident: $field_type:ty = $value:expr,)*
        }
    ) => {
        $(#[$doc])*
        $vis struct $type {
            entry: $crate::registry::Entry,
            /// Function that makes the object.
            pub build: $build,
            $($(#[$field_doc])* pub $field: $field_type,)*
        }

        impl $type {
            /// For [`zelus_core::register`](crate::register).
            pub const fn new(entry: $crate::registry::Entry, build: $build) -> Self {
                Self { entry, build, $($field: $value,)* }
            }

            $($(#[$field_doc])* pub const fn $field(mut self, value: $field_type) -> Self {
                self.$field = value;
                self
            })*
        }

        impl std::ops::Deref for $type {
            type Target = $crate::registry::Entry;

            fn deref(&self) -> &$crate::registry::Entry {
                &self.entry
            }
        }

        $crate::collect_kind! { $type($word, $unknown) }
    };
}

/// Registers a type that dereferences to its [`Entry`](crate::registry::Entry) as the entries of a kind.
#[macro_export]
macro_rules! collect_kind {
    ($type:ident($word:literal, $unknown:literal)) => {
        impl $crate::registry::Registered for $type {
            const KIND: &'static str = $word;
            const UNKNOWN: &'static str = $unknown;

            fn entry(&self) -> &$crate::registry::Entry {
                self
            }
        }

        $crate::inventory::collect!($type);
        $crate::inventory::submit! { $crate::registry::Kind::of::<$type>() }
    };
}
