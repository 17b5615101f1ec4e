//! The oracle against what shares no arithmetic with it: the matrix exponential of mechanism and drive, and conservation.

use luztar::dynamics::oracle::{Body, Signal, Spring, System, exact};
use luztar::dynamics::{EventKind, Start};
use nalgebra::DMatrix;
use proptest::prelude::*;

/// Rounding over some hundred stretches, and of Pade's approximation behind `exp`.
const ROUNDING: f64 = 1e-11;

fn free(inertia: f64, load: Signal) -> Body {
    Body {
        inertia,
        viscous: [0.0; 2],
        kinetic: [0.0; 2],
        held: [0.0; 2],
        ground_speed: 0.0,
        load,
    }
}

/// A drive of one sine and a cubic, and the matrix whose exponential moves it: 1, t, t^2 / 2, t^3 / 6, sin, cos.
struct Drive {
    cubic: [f64; 4],
    sine: [f64; 3],
}

impl Drive {
    fn signal(&self) -> Signal {
        Signal::new(&[0.0], &[self.cubic], &[self.sine]).expect("a fine signal")
    }

    fn row(&self) -> [f64; 6] {
        let [a, b, c, d] = self.cubic;
        let [amplitude, _, phase] = self.sine;
        [
            a,
            b,
            2.0 * c,
            6.0 * d,
            amplitude * phase.cos(),
            amplitude * phase.sin(),
        ]
    }
}

/// State after some seconds by the exponential of the whole.
fn by_exponential(
    inertia: &[f64],
    stiffness: &[f64],
    damping: &[f64],
    drive: &Drive,
    start: &[f64],
    seconds: f64,
) -> Vec<f64> {
    let n = inertia.len();
    let size = 2 * n + 6;
    let mut a = DMatrix::<f64>::zeros(size, size);
    for i in 0..n {
        a[(i, n + i)] = 1.0;
        for j in 0..n {
            a[(n + i, j)] = -stiffness[i * n + j] / inertia[i];
            a[(n + i, n + j)] = -damping[i * n + j] / inertia[i];
        }
    }
    for (k, value) in drive.row().into_iter().enumerate() {
        a[(n, 2 * n + k)] = value / inertia[0];
    }
    for k in 1..4 {
        a[(2 * n + k, 2 * n + k - 1)] = 1.0;
    }
    let w = drive.sine[1];
    a[(2 * n + 4, 2 * n + 5)] = w;
    a[(2 * n + 5, 2 * n + 4)] = -w;
    let mut z = DMatrix::<f64>::zeros(size, 1);
    for (k, value) in start.iter().enumerate() {
        z[(k, 0)] = *value;
    }
    z[(2 * n, 0)] = 1.0;
    z[(2 * n + 5, 0)] = 1.0;
    let end = (a * seconds).exp() * z;
    (0..2 * n).map(|k| end[(k, 0)]).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Any springs and dampers, also none, equal or as many as make a repeated eigenvalue, and a drive at resonance.
    #[test]
    fn the_motion_of_a_mode_is_the_exponential_of_its_matrix(
        inertia in prop::collection::vec(0.2..5.0, 3),
        springs in prop::collection::vec(prop_oneof![Just(0.0), Just(1.0), 0.0..60.0], 6),
        dampers in prop::collection::vec(prop_oneof![Just(0.0), Just(2.0), 0.0..9.0], 6),
        cubic in prop::collection::vec(-1.0..1.0, 4),
        sine in (-1.0..1.0, prop_oneof![Just(0.0), Just(1.0), 0.0..20.0], -3.0..3.0),
        start in prop::collection::vec(-1.0..1.0, 6),
        seconds in 0.01..3.0,
    ) {
        let n = 3;
        // Each value is a spring between two bodies, or between one and the ground.
        let matrix = |values: &[f64]| {
            let mut m = vec![0.0; n * n];
            for (k, (i, j)) in [(0, 1), (1, 2), (0, 2)].into_iter().enumerate() {
                m[i * n + i] += values[k];
                m[j * n + j] += values[k];
                m[i * n + j] -= values[k];
                m[j * n + i] -= values[k];
            }
            for i in 0..n {
                m[i * n + i] += values[3 + i];
            }
            m
        };
        let (stiffness, damping) = (matrix(&springs), matrix(&dampers));
        let drive = Drive {
            cubic: [cubic[0], cubic[1], cubic[2], cubic[3]],
            sine: [sine.0, sine.1, sine.2],
        };
        let bodies = (0..n)
            .map(|i| free(inertia[i], if i == 0 { drive.signal() } else { Signal::constant(0.0) }))
            .collect();
        let system = System::new(bodies, &stiffness, &damping, vec![]).expect("a fine system");
        let starts: Vec<Start> = (0..n).map(|i| Start { phi: start[i], speed: start[n + i] }).collect();
        let run = exact(&system, &starts, &[0.0, seconds], 10_000).expect("it runs");
        let other = by_exponential(&inertia, &stiffness, &damping, &drive, &start, seconds);
        for i in 0..n {
            let (angle, speed) = (run.angle[i][1], run.speed[i][1]);
            prop_assert!((angle - other[i]).abs() < ROUNDING * (1.0 + other[i].abs()), "{angle} {}", other[i]);
            prop_assert!((speed - other[n + i]).abs() < ROUNDING * 10.0 * (1.0 + other[n + i].abs()));
        }
    }

    /// Between a gap and two dry frictions the energy of motion and springs only falls, and each event is on its edge.
    #[test]
    fn friction_only_takes_energy_and_events_lie_on_their_edges(
        inertia in (0.2..5.0, 0.2..5.0),
        spring in (1.0..60.0, 1.0..60.0),
        half_gap in prop_oneof![Just(0.0), Just(1e-9), 0.001..0.3],
        level in prop::collection::vec(0.0..2.0, 4),
        start in prop::collection::vec(-1.0..1.0, 4),
    ) {
        let body = |inertia: f64, kinetic: f64, extra: f64| Body {
            kinetic: [kinetic; 2],
            held: [kinetic + extra; 2],
            ..free(inertia, Signal::constant(0.0))
        };
        let bodies = vec![body(inertia.0, level[0], level[1]), body(inertia.1, level[2], level[3])];
        let gap = Spring { stiffness: spring.1, half_gap, end: Signal::constant(0.0), at: vec![1.0, -1.0] };
        let stiffness = [spring.0, 0.0, 0.0, 0.0];
        let system = System::new(bodies, &stiffness, &[0.0; 4], vec![gap]).expect("a fine system");
        let starts = [0, 1].map(|i| Start { phi: start[i], speed: start[2 + i] });
        let times: Vec<f64> = (0..400).map(|k| f64::from(k) * 0.05).collect();
        let run = exact(&system, &starts, &times, 10_000).expect("it runs");
        let stored = |k: usize| {
            let z = -run.angle[0][k] + run.angle[1][k];
            let wound = z - z.clamp(-half_gap, half_gap);
            0.5 * (inertia.0 * run.speed[0][k].powi(2) + inertia.1 * run.speed[1][k].powi(2)
                + spring.0 * run.angle[0][k].powi(2) + spring.1 * wound * wound)
        };
        for k in 1..times.len() {
            prop_assert!(stored(k) <= stored(k - 1) * (1.0 + 1e-13) + 1e-26);
        }
        for event in &run.events {
            if matches!(event.kind, EventKind::Contact | EventKind::Release) {
                let edge = f64::from(event.direction) * half_gap;
                prop_assert!((event.angle - edge).abs() < 1e-14, "{event:?}");
            }
        }
    }
}

#[test]
fn more_events_than_allowed_are_an_error_that_says_when() {
    let body = free(1.0, Signal::constant(0.0));
    let system = System::new(vec![body], &[1.0], &[0.0], vec![]).expect("a fine system");
    let start = Start {
        phi: 1.0,
        speed: 0.0,
    };
    let error = exact(&system, &[start], &[0.0, 1e3], 20).expect_err("it swings for ever");
    // The first event is the start; the twentieth reversal is one too many.
    let text = error.to_string();
    assert!(text.starts_with("more than 20 events until 62.8"), "{text}");
}
