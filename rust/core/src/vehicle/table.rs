//! Named parameters as rows of a table with one column per lane.

/// Declares the parameters of a car: fields, public names, what values they take.
macro_rules! parameters {
    ($($field:ident: $name:literal, $domain:ident;)*) => {
        /// The parameters of a car and its steering; units in the names.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct Parameters {
            $(#[doc = concat!("`", $name, "`")] pub $field: f64,)*
        }

        /// Their public names, in the order of [`Parameters::from_slice`].
        pub const NAMES: &[&str] = &[$($name),*];

        const DOMAINS: &[Domain] = &[$(Domain::$domain),*];

        impl Parameters {
            fn read(values: &[f64]) -> Self {
                let mut each = values.iter().copied();
                Self { $($field: each.next().unwrap_or(f64::NAN),)* }
            }
        }
    };
}

/// Declares a set of numbers of a lane that is kept as rows of a table, one column per lane.
macro_rules! lane_rows {
    ($(#[$meta:meta])* $name:ident, $rows:ident: $($(#[$doc:meta])* $field:ident,)*) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy)]
        pub(super) struct $name {
            $($(#[$doc])* pub $field: Pure,)*
        }

        /// How many numbers that are.
        pub(super) const $rows: usize = [$(stringify!($field)),*].len();

        impl $name {
            /// The numbers of one lane.
            #[inline(always)]
            pub fn gather<const N: usize>(table: &[[f64; N]; $rows], lane: usize) -> Self {
                let mut row = 0..$rows;
                Self { $($field: Pure(table[$crate::vehicle::table::next(&mut row, stringify!($field))][lane]),)* }
            }

            /// Writes them into the column of a lane.
            #[inline(always)]
            pub fn scatter<const N: usize>(&self, table: &mut [[f64; N]; $rows], lane: usize) {
                let mut row = 0..$rows;
                $(table[$crate::vehicle::table::next(&mut row, stringify!($field))][lane] = self.$field.0;)*
            }
        }
    };
}

/// The next row; the rows are as many as the fields.
#[inline(always)]
pub(super) fn next(rows: &mut std::ops::Range<usize>, _field: &str) -> usize {
    let row = rows.start;
    rows.start += 1;
    row
}

pub(super) use {lane_rows, parameters};
