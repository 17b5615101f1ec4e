//! A step of a mechanism allocates nothing, through stick, slip and reversals: a counting allocator looks.

mod counting_allocator;

use counting_allocator::allocations;
use luztar::mechanism::{Body, Element, End, Law, Network, Node, Stepper};

fn end(node: Node, ratio: f64) -> End {
    End { node, ratio }
}

/// Three bodies behind a driven node, with a redundant set of frictions, damping, drag, Stribeck and assistance.
fn network() -> Network {
    let body = |name: &str, inertia| Body {
        name: name.to_owned(),
        inertia,
    };
    let element = |name: &str, a, b, law| Element {
        name: name.to_owned(),
        a,
        b,
        law,
    };
    let (hand, ground) = (end(Node::Driven(0), 1.0), end(Node::Ground, 1.0));
    let at = |i| end(Node::Body(i), 1.0);
    let spring = |stiffness, gap| Law::Spring {
        stiffness,
        gap,
        hardening: 0.0,
    };
    let friction = |level, stiction| Law::Friction {
        level,
        difference: 0.0,
        stribeck: 0.1 * level,
        stribeck_speed: 0.2,
        stiction,
    };
    let elements = vec![
        element("k0", hand, at(0), spring(40.0, 0.05)),
        element("k1", at(0), at(1), spring(60.0, 0.02)),
        element("k2", at(1), at(2), spring(30.0, 0.0)),
        element(
            "c",
            at(0),
            at(2),
            Law::Damper {
                viscous: 0.3,
                drag: 0.1,
            },
        ),
        element("f0", at(0), ground, friction(0.4, 0.2)),
        element("f1", at(1), ground, friction(0.5, 0.0)),
        element("f01", at(0), at(1), friction(0.3, 0.1)),
        element("f12", at(1), at(2), friction(0.2, 0.0)),
        element(
            "assist",
            hand,
            at(0),
            Law::Assist {
                on: at(1),
                scale: 1.0,
                terms: vec![(5.0, 0.02), (-5.0, 0.2)],
            },
        ),
    ];
    Network::new(
        vec![body("one", 1.0), body("two", 0.5), body("three", 0.8)],
        vec!["hand".to_owned()],
        vec![("load".to_owned(), 2)],
        elements,
    )
    .expect("sound")
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| drop(std::hint::black_box(Box::new(1)))), 1);
}

#[test]
fn a_step_through_all_modes_allocates_nothing() {
    let still = [0.0; 3];
    let mut stepper =
        Stepper::new(&network(), 1e-3, 2, (&still, &still), &[0.0, 0.0]).expect("sound");
    let (mut held, mut slid, mut turned) = (0, 0, 0);
    let mut last = stepper.modes().to_vec();
    let made = allocations(|| {
        for i in 0..20_000 {
            let t = f64::from(i) * 1e-3;
            let hand = 0.3 * (3.1 * t).sin() * (0.7 * t).sin();
            stepper
                .step(&[hand, 0.8 * (5.3 * t).sin()])
                .expect("finite");
            for (old, new) in last.iter_mut().zip(stepper.modes()) {
                held += usize::from(*new == 0);
                slid += usize::from(*new != 0);
                turned += usize::from(*new != *old);
                *old = *new;
            }
        }
    });
    assert_eq!(made, 0);
    assert!(
        held > 1000 && slid > 1000 && turned > 50,
        "{held} {slid} {turned}"
    );
}

#[test]
fn a_refused_step_leaves_the_state() {
    let still = [0.0; 3];
    let mut stepper =
        Stepper::new(&network(), 1e-3, 1, (&still, &still), &[0.0, 0.0]).expect("sound");
    stepper.step(&[0.1, 0.0]).expect("finite");
    let before = stepper.state();
    assert!(stepper.step(&[f64::NAN, 0.0]).is_err());
    assert!(stepper.step(&[0.1]).is_err());
    assert_eq!(stepper.state(), before);
}
