//! Four poles at 6 Hz and 1 kHz, a million samples: luztar on every instruction set, sci-rs, biquad, and a plain copy.

use std::hint::black_box;

use biquad::{Biquad, Coefficients, DirectForm2Transposed, Hertz, Type};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use luztar::signal::{
    Band, Butterworth, CutoffAt, Edges, Filter, InstructionSet, Passes, ZeroPhase,
};
use sci_rs::signal::filter::design::{
    DigitalFilter, FilterBandType, FilterOutputType, Sos, SosFormatFilter, butter_dyn,
};
use sci_rs::signal::filter::{sosfilt_dyn, sosfiltfilt_dyn};

const SAMPLES: usize = 1_000_000;
const CUTOFF_HZ: f64 = 6.0;
const RATE_HZ: f64 = 1000.0;

fn record() -> Vec<f64> {
    (0..SAMPLES)
        .map(|i| 100.0 + (i as f64 / 80.0).sin())
        .collect()
}

fn design(passes: Passes) -> Butterworth {
    let band = Band::Low {
        cutoff_hz: CUTOFF_HZ,
    };
    Butterworth::new(4, band, RATE_HZ, passes, CutoffAt::PerPass).expect("in range")
}

fn sections_of_sci_rs() -> Vec<Sos<f64>> {
    let made = butter_dyn(
        4,
        vec![CUTOFF_HZ],
        Some(FilterBandType::Lowpass),
        Some(false),
        Some(FilterOutputType::Sos),
        Some(RATE_HZ),
    );
    let DigitalFilter::Sos(SosFormatFilter { sos }) = made else {
        panic!("sections were asked for");
    };
    sos
}

fn sets() -> impl Iterator<Item = InstructionSet> {
    InstructionSet::ALL
        .into_iter()
        .filter(|set| set.available())
}

fn zero_phase(criterion: &mut Criterion) {
    let (x, mut out) = (record(), vec![0.0; SAMPLES]);
    let mut group = criterion.benchmark_group("zero_phase");
    group
        .throughput(Throughput::Elements(SAMPLES as u64))
        .sample_size(20);
    for set in sets() {
        let filter = ZeroPhase::on(&design(Passes::ForwardBackward), Edges::default(), set)
            .expect("settles");
        group.bench_function(BenchmarkId::new("luztar", set.name()), |bencher| {
            bencher.iter(|| filter.apply(black_box(&x), &mut out).expect("finite"));
        });
    }
    let sections = sections_of_sci_rs();
    group.bench_function("sci-rs", |bencher| {
        bencher.iter(|| black_box(sosfiltfilt_dyn(x.iter(), &sections)));
    });
    group.bench_function("copy", |bencher| {
        bencher.iter(|| out.copy_from_slice(black_box(&x)))
    });
    group.finish();
}

fn causal(criterion: &mut Criterion) {
    let (x, mut out) = (record(), vec![0.0; SAMPLES]);
    let mut group = criterion.benchmark_group("causal");
    group
        .throughput(Throughput::Elements(SAMPLES as u64))
        .sample_size(20);
    for set in sets() {
        let mut filter = Filter::on(design(Passes::Forward), set);
        group.bench_function(BenchmarkId::new("luztar", set.name()), |bencher| {
            bencher.iter(|| filter.push_into(black_box(&x), &mut out).expect("finite"));
        });
    }
    let mut sections = sections_of_sci_rs();
    group.bench_function("sci-rs", |bencher| {
        bencher.iter(|| black_box(sosfilt_dyn(x.iter(), &mut sections)));
    });
    // biquad designs one section at a time: those of four poles have the qualities 0.5412 and 1.3066.
    let mut pair = [0.541_196_1, 1.306_563].map(|quality| {
        let hertz = |f: f64| Hertz::<f64>::from_hz(f).expect("positive");
        let made =
            Coefficients::from_params(Type::LowPass, hertz(RATE_HZ), hertz(CUTOFF_HZ), quality);
        DirectForm2Transposed::<f64>::new(made.expect("in range"))
    });
    group.bench_function("biquad", |bencher| {
        bencher.iter(|| {
            for (x, out) in black_box(&x).iter().zip(&mut out) {
                *out = pair.iter_mut().fold(*x, |v, section| section.run(v));
            }
        });
    });
    group.finish();
}

criterion_group!(benches, zero_phase, causal);
criterion_main!(benches);
