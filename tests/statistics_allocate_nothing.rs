//! A push allocates nothing: every allocation of this test's process is counted.

mod counting_allocator;

use counting_allocator::allocations;
use std::hint::black_box;

use luztar::regression::{
    LineSums, LinearSums, PolynomialSums, Recursive, RollingLine, RollingPolynomial,
};
use luztar::stats::{Counts, Moments, QuantileSketch, Rolling, Settings};

fn samples() -> Vec<f64> {
    (0..5000)
        .map(|i| (f64::from(i) * 0.01).sin() * 3.0)
        .collect()
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| drop(black_box(vec![1.0; 10]))), 1);
}

#[test]
fn pushing_samples_allocates_nothing() {
    let x = samples();
    let settings = Settings {
        shape: true,
        skip_nan: true,
        ..Settings::default()
    };
    let (mut moments, mut skipping) = (Moments::default(), Moments::new(settings));
    let mut rolling = Rolling::new(300).expect("in range");
    let mut sketch = QuantileSketch::new(0.01).expect("in range");
    let mut rows = vec![0.0; 4 * 10];
    let found = allocations(|| {
        for chunk in x.chunks(10) {
            moments.push(chunk).expect("finite");
            skipping.push(chunk).expect("finite");
            rolling
                .push_into(chunk, &mut rows[..4 * chunk.len()])
                .expect("finite");
            sketch.push(chunk).expect("finite");
        }
        moments.push(&x).expect("finite");
        black_box(moments.figures().std_sample());
        black_box(rolling.figures());
    });
    assert_eq!(found, 0);
}

#[test]
fn counting_known_values_allocates_nothing() {
    let x: Vec<i16> = samples().iter().map(|v| (v * 1000.0) as i16).collect();
    let mut counts = Counts::new();
    counts.push(&x).expect("few pages");
    assert_eq!(allocations(|| counts.push(&x).expect("few pages")), 0);
}

#[test]
fn pushing_points_allocates_nothing() {
    let x = samples();
    let mut line = LineSums::with_forgetting(0.999).expect("in range");
    let mut rolling = RollingLine::new(300).expect("in range");
    let mut linear = LinearSums::new(2, true, 0.999).expect("in range");
    let mut polynomial = PolynomialSums::new(3, (-3.0, 3.0), 1.0).expect("in range");
    let mut last = RollingPolynomial::new(2, 300).expect("in range");
    let mut recursive = Recursive::new(&[0.0, 0.0], 1e3, 0.999).expect("in range");
    let (mut errors, mut coefficients) = ([0.0; 10], [0.0; 2]);
    let found = allocations(|| {
        for chunk in x.chunks_exact(20) {
            let y = &chunk[..10];
            line.push(y, &chunk[10..]).expect("finite");
            rolling.push(y, &chunk[10..]).expect("finite");
            last.push(y, &chunk[10..]).expect("finite");
            linear.push(chunk, y, None).expect("finite");
            polynomial.push(y, &chunk[10..], None).expect("finite");
            recursive.push(chunk, y, Some(&mut errors)).expect("finite");
            recursive.coefficients_into(&mut coefficients).expect("two");
        }
        black_box(line.fit().expect("varies"));
    });
    assert_eq!(found, 0);
}
