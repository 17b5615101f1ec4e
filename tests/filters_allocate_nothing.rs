//! Nothing is allocated where samples run: a counting allocator looks.

mod counting_allocator;

use counting_allocator::allocations;
use luztar::signal::{
    Band, Bank, Butterworth, CutoffAt, Edges, Filter, FixedLag, InstructionSet, Passes, Scale,
    ZeroPhase,
};

fn design(passes: Passes) -> Butterworth {
    Butterworth::new(
        4,
        Band::Low { cutoff_hz: 6.0 },
        1000.0,
        passes,
        CutoffAt::PerPass,
    )
    .expect("in range")
}

fn record(n: usize) -> Vec<f64> {
    (0..n).map(|i| 100.0 + (i as f64 / 80.0).sin()).collect()
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| drop(std::hint::black_box(Box::new(1)))), 1);
}

#[test]
fn a_push_allocates_nothing() {
    let (x, mut out) = (record(1000), vec![0.0; 1000]);
    for set in InstructionSet::ALL
        .into_iter()
        .filter(|set| set.available())
    {
        let mut filter = Filter::on(design(Passes::Forward), set);
        let counts: Vec<i16> = (0..1000).collect();
        let scale = Scale {
            factor: 0.01,
            offset: 1.0,
        };
        let (single, mut single_out) = (vec![1.0_f32; 1000], vec![0.0_f32; 1000]);
        let made = allocations(|| {
            for length in [1, 10, 16, 17, 64, 1000] {
                filter
                    .push_into(&x[..length], &mut out[..length])
                    .expect("finite");
                filter.push_in_place(&mut out[..length]).expect("finite");
                filter
                    .push_samples(&counts[..length], scale, &mut out[..length])
                    .expect("finite");
                filter
                    .push_single(&single[..length], &mut single_out[..length])
                    .expect("finite");
            }
            filter.reset(Some(3.0)).expect("finite");
        });
        assert_eq!(made, 0, "{}", set.name());
    }
}

#[test]
fn a_bank_and_a_fixed_lag_allocate_nothing() {
    let set = InstructionSet::best();
    let mut bank = Bank::new(design(Passes::Forward), 19, set).expect("channels");
    let mut frames = record(19 * 200);
    let mut live = FixedLag::new(&design(Passes::ForwardBackward), 130, set).expect("delay");
    let (x, mut out) = (record(3000), vec![0.0; 3000]);
    let made = allocations(|| {
        bank.push_in_place(&mut frames).expect("finite");
        for (x, out) in x.chunks(7).zip(out.chunks_mut(7)) {
            live.push_into(x, out).expect("finite");
        }
    });
    assert_eq!(made, 0);
}

#[test]
fn a_record_allocates_nothing() {
    let filter =
        ZeroPhase::new(&design(Passes::ForwardBackward), Edges::default()).expect("settles");
    for n in [1, 2, 30, 1000, 2000, 5000] {
        let (x, mut out) = (record(n), vec![0.0; n]);
        assert_eq!(
            allocations(|| filter.apply(&x, &mut out).expect("finite")),
            0,
            "{n} samples"
        );
        assert_eq!(
            allocations(|| filter.apply_in_place(&mut out).expect("finite")),
            0,
            "{n} samples"
        );
    }
}
