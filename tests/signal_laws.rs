//! Laws of the filters that hold for every design and every record.

use luztar::signal::{Band, Butterworth, CutoffAt, Edges, Filter, Passes, ZeroPhase, zero_phase};
use proptest::prelude::*;

/// What the extension leaves of the filter's memory, times a hundred for the residues of twelve poles in two passes.
const EDGE_MEMORY: f64 = 100.0 * 1e-9;

fn design(poles: usize, ratio: f64, passes: Passes) -> Butterworth {
    Butterworth::new(
        poles,
        Band::Low { cutoff_hz: ratio },
        1.0,
        passes,
        CutoffAt::PerPass,
    )
    .expect("in range")
}

fn both_ways(poles: usize, ratio: f64, x: &[f64]) -> Vec<f64> {
    let mut out = vec![f64::NAN; x.len()];
    let low_pass = design(poles, ratio, Passes::ForwardBackward);
    zero_phase(&low_pass, x, Edges::default(), &mut out).expect("finite");
    out
}

fn farthest(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// Rounding once per pole, pass and sample, adding up as a random walk over the filter's memory.
fn rounding(poles: usize, ratio: f64) -> f64 {
    2.0 * poles as f64 * f64::EPSILON * (1.0 + ratio.recip().sqrt())
}

/// How high the extension of a short record climbs: the record's swing once per turn, over the filter's memory.
fn reach(x: &[f64], poles: usize, ratio: f64) -> f64 {
    let memory = design(poles, ratio, Passes::ForwardBackward)
        .settle_samples(1e-9)
        .expect("in range");
    2.0 * largest(x) * (2.0 + memory as f64 / (x.len().max(2) - 1) as f64)
}

fn record() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-100.0..100.0_f64, 1..400)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn zero_phase_of_a_constant_is_the_constant(
        poles in 1_usize..=12, ratio in 1e-5..0.499_f64, n in 1_usize..200, value in -1e9..1e9_f64,
    ) {
        let x = vec![value; n];
        prop_assert_eq!(both_ways(poles, ratio, &x), x);
    }

    #[test]
    fn causal_filter_passes_a_constant_unchanged_from_the_first_sample(
        poles in 1_usize..=12, ratio in 1e-8..0.499_f64, n in 1_usize..200, value in -1e9..1e9_f64,
    ) {
        let x = vec![value; n];
        let mut filter = Filter::new(design(poles, ratio, Passes::Forward));
        prop_assert_eq!(filter.push(&x).expect("finite"), x);
    }

    #[test]
    fn a_sum_is_filtered_as_the_sum_of_the_filtered(
        poles in 1_usize..=12, ratio in 1e-3..0.49_f64, x in record(), a in -3.0..3.0_f64,
    ) {
        let other: Vec<f64> = x.iter().rev().map(|v| v.sin()).collect();
        let sum: Vec<f64> = x.iter().zip(&other).map(|(v, w)| a * v + w).collect();
        let (fx, fo, fs) = (both_ways(poles, ratio, &x), both_ways(poles, ratio, &other), both_ways(poles, ratio, &sum));
        let of_parts: Vec<f64> = fx.iter().zip(&fo).map(|(v, w)| a * v + w).collect();
        let scale = 3.0 * reach(&x, poles, ratio);
        prop_assert!(farthest(&fs, &of_parts) <= 4.0 * rounding(poles, ratio) * scale);
    }

    #[test]
    fn a_reversed_record_gives_the_reversed_answer(
        poles in 1_usize..=12, ratio in 1e-3..0.45_f64, x in record(),
    ) {
        let backwards: Vec<f64> = x.iter().rev().copied().collect();
        let mut there_and_back = both_ways(poles, ratio, &backwards);
        there_and_back.reverse();
        let difference = farthest(&both_ways(poles, ratio, &x), &there_and_back);
        prop_assert!(difference <= EDGE_MEMORY * reach(&x, poles, ratio));
    }

    #[test]
    fn a_ramp_stays_the_same_ramp(
        poles in 1_usize..=12, ratio in 1e-3..0.45_f64, n in 1_usize..2000, slope in -10.0..10.0_f64,
    ) {
        let x: Vec<f64> = (0..n).map(|i| 3.0 + slope * i as f64).collect();
        let bound = rounding(poles, ratio) * reach(&x, poles, ratio);
        prop_assert!(farthest(&both_ways(poles, ratio, &x), &x) <= bound);
    }

    #[test]
    fn chunks_of_any_size_give_the_same_bits(
        poles in 1_usize..=12, ratio in 1e-7..0.499_f64, x in record(), cuts in prop::collection::vec(0_usize..400, 0..10),
    ) {
        let low_pass = design(poles, ratio, Passes::Forward);
        let whole = Filter::new(low_pass).push(&x).expect("finite");
        let mut cuts: Vec<usize> = cuts.into_iter().map(|c| c.min(x.len())).collect();
        cuts.extend([0, x.len()]);
        cuts.sort_unstable();
        let mut filter = Filter::new(low_pass);
        let mut joined = Vec::new();
        for pair in cuts.windows(2) {
            joined.extend(filter.push(&x[pair[0]..pair[1]]).expect("finite"));
        }
        prop_assert_eq!(joined, whole);
    }

    #[test]
    fn a_stored_memory_continues_with_the_same_bits(
        poles in 1_usize..=12, ratio in 1e-7..0.499_f64, x in record(), cut in 0_usize..400,
    ) {
        let low_pass = design(poles, ratio, Passes::Forward);
        let (first, second) = x.split_at(cut.min(x.len()));
        let mut filter = Filter::new(low_pass);
        filter.push(first).expect("finite");
        let mut twin = Filter::new(low_pass);
        twin.restore(&filter.state()).expect("its own");
        prop_assert_eq!(filter.push(second), twin.push(second));
    }

    #[test]
    fn in_place_gives_the_same_bits(poles in 1_usize..=12, ratio in 1e-4..0.49_f64, x in record()) {
        let filter = ZeroPhase::new(&design(poles, ratio, Passes::ForwardBackward), Edges::default()).expect("settles");
        let mut own = x.clone();
        filter.apply_in_place(&mut own).expect("finite");
        prop_assert_eq!(own, both_ways(poles, ratio, &x));
    }

    #[test]
    fn any_numbers_are_filtered_or_refused_without_a_panic(
        poles in 0_usize..20, cutoff_hz in prop_oneof![any::<f64>(), 0.1..500.0_f64], x in prop::collection::vec(any::<f64>(), 0..30),
        tolerance in prop_oneof![Just(1e-9), any::<f64>()],
    ) {
        if let Ok(low_pass) = Butterworth::new(poles, Band::Low { cutoff_hz }, 1000.0, Passes::ForwardBackward, CutoffAt::Overall) {
            // a cut-off that needs a long extension is only slow, not interesting here
            prop_assume!(low_pass.settle_samples(1e-9).expect("in range") < 100_000);
            let mut out = vec![0.0; x.len()];
            let tolerance = tolerance.max(1e-300);
            if zero_phase(&low_pass, &x, Edges::Settled { tolerance }, &mut out).is_ok() {
                prop_assert!(out.iter().all(|v| v.is_finite()));
            }
        }
    }
}
