//! Laws of the moments and of the line: parts merged are the whole pushed.

use luztar::regression::{LineSums, fit_line};
use luztar::stats::Moments;
use proptest::prelude::*;

/// One rounding per merged block sum: a few dozen for the lengths below, on numbers that do not cancel.
const MERGE_ROUNDING: f64 = 64.0 * f64::EPSILON;

fn record() -> impl Strategy<Value = Vec<f64>> {
    (prop::collection::vec(-1.0..1.0_f64, 1..3000), -1e6..1e6_f64)
        .prop_map(|(x, level)| x.into_iter().map(|v| v + level).collect())
}

fn moments(x: &[f64]) -> Moments {
    let mut m = Moments::default();
    m.push(x).expect("finite");
    m
}

fn line_sums(x: &[f64], y: &[f64]) -> LineSums {
    let mut sums = LineSums::new();
    sums.push(x, y).expect("finite");
    sums
}

fn close(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * a.abs().max(b.abs())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn merged_moments_are_those_of_the_joined_record(x in record(), cut in 0_usize..3000) {
        let (a, b) = x.split_at(cut.min(x.len()));
        let mut merged = moments(a);
        merged.merge(&moments(b)).expect("alike");
        let whole = moments(&x);
        prop_assert_eq!(merged.count(), whole.count());
        prop_assert!(close(merged.figures().mean().expect("some"), whole.figures().mean().expect("some"), f64::EPSILON));
        prop_assert!(close(merged.figures().sum_of_squares(), whole.figures().sum_of_squares(), MERGE_ROUNDING));
        prop_assert_eq!((merged.min(), merged.max()), (whole.min(), whole.max()));
    }

    #[test]
    fn merging_is_associative_up_to_rounding(x in record(), y in record(), z in record()) {
        let (x, y, z) = (moments(&x), moments(&y), moments(&z));
        let (mut left, mut right, mut tail) = (x, x, y);
        left.merge(&y).expect("alike");
        left.merge(&z).expect("alike");
        tail.merge(&z).expect("alike");
        right.merge(&tail).expect("alike");
        prop_assert!(close(left.figures().sum_of_squares(), right.figures().sum_of_squares(), MERGE_ROUNDING));
        prop_assert_eq!((left.min(), left.max()), (right.min(), right.max()));
    }

    #[test]
    fn a_level_moves_the_mean_and_not_the_spread(x in prop::collection::vec(-1000_i32..1000, 2..2000), level in -1_000_000_i32..1_000_000) {
        // whole numbers: adding the level is exact, so the spread must be the same to the last bits
        let low: Vec<f64> = x.iter().map(|v| f64::from(*v)).collect();
        let high: Vec<f64> = x.iter().map(|v| f64::from(*v) + f64::from(level) * 1e6).collect();
        prop_assert!(close(moments(&low).figures().sum_of_squares(), moments(&high).figures().sum_of_squares(), MERGE_ROUNDING));
    }

    #[test]
    fn merged_line_sums_are_those_of_the_joined_record(x in record(), cut in 0_usize..3000) {
        prop_assume!(x.len() > 2);
        let y: Vec<f64> = x.iter().enumerate().map(|(i, v)| 2.0 * v + (i as f64).sin()).collect();
        let cut = cut.min(x.len());
        let mut merged = line_sums(&x[..cut], &y[..cut]);
        merged.merge(&line_sums(&x[cut..], &y[cut..]));
        let (merged, whole) = (merged.fit().expect("varies"), line_sums(&x, &y).fit().expect("varies"));
        prop_assert_eq!(merged.n, whole.n);
        // the products may cancel in the slope; against the scale of y over x they do not
        prop_assert!((merged.slope - whole.slope).abs() <= MERGE_ROUNDING * (3.0 + whole.slope.abs()) * x.len() as f64);
    }

    #[test]
    fn an_exact_line_is_found(n in 2_usize..3000, slope in -100_i32..100, intercept in -1000_i32..1000) {
        let x: Vec<f64> = (0..n).map(|i| i as f64).collect();
        let y: Vec<f64> = x.iter().map(|v| f64::from(intercept) + f64::from(slope) * v).collect();
        let line = fit_line(&x, &y, None).expect("varies");
        prop_assert!(close(line.slope, f64::from(slope), 8.0 * f64::EPSILON));
        let height = f64::from(slope.abs()) * n as f64;
        prop_assert!((line.intercept - f64::from(intercept)).abs() <= 8.0 * f64::EPSILON * (height + 1000.0));
    }
}
