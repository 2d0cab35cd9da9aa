//! The macros by which kinds are declared and objects registered.

/// Registers one object under its name: the last lines of its file.
///
/// The first word is the type of the entry. `aliases`, `about`, `source`, `defaults` and `like` are fields of every
/// [`Entry`](crate::registry::Entry); `build` makes the object; further facts are methods of the entry's type.
///
/// ```
/// use zelus_core::processes::{Process, ProcessEntry};
/// use zelus_core::{register, registry};
///
/// struct Pause;
///
/// impl Process for Pause {}
///
/// register! { ProcessEntry "pause_process",
///     aliases: &["PauseProcess"],
///     about: "waits",
///     defaults: r#"{ "seconds": 1.0 }"#, // as a rule a file of `configs`, by include_str!
///     build: |_| Ok(Box::new(Pause)),
/// }
/// let entry = registry::find::<ProcessEntry>("PauseProcess").expect("the one above");
/// assert_eq!((entry.name, entry.about), ("pause_process", "waits"));
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
/// ```
/// use zelus_core::entities::ElementEntry;
/// use zelus_core::{register_absent, registry};
///
/// register_absent! { ElementEntry ["Shell", "Sprism"] => "use solid elements, three or more across the thickness" }
/// let problem = registry::require::<ElementEntry>("ShellThinElement3D3N").err().expect("no such element");
/// assert_eq!(problem.remedy.as_deref(), Some("use solid elements, three or more across the thickness"));
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
/// ```
/// use zelus_core::{register, registered_kind, registry};
///
/// registered_kind! {
///     /// A law of the drag of a body by its speed.
///     pub struct DragLawEntry("drag_law", "unknown-drag-law") {
///         build: fn(f64) -> f64;
///         /// Whether drag acts from all sides alike.
///         isotropic: bool = true,
///     }
/// }
/// register! { DragLawEntry "quadratic", about: "drag by the square of the speed", isotropic: false, build: |speed| speed * speed }
///
/// let law = registry::require::<DragLawEntry>("quadratic").expect("the one above");
/// assert_eq!(((law.build)(3.0), law.isotropic), (9.0, false));
/// assert_eq!(registry::require::<DragLawEntry>("cubic").err().expect("no such law").code, "unknown-drag-law");
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
