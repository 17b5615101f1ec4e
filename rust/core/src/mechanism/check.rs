//! What a mechanism must not be: every refusal names the body or the element and the remedy.

use crate::Error;

use super::network::{Element, End, Law, Network, Node};

fn refuse<T>(place: &str, problem: String, remedy: &str) -> Result<T, Error> {
    Err(Error::Mechanism {
        place: place.to_owned(),
        problem,
        remedy: remedy.to_owned(),
    })
}

/// Refuses a mechanism that makes no sense.
pub(super) fn check(network: &Network) -> Result<(), Error> {
    if network.bodies().is_empty() {
        return refuse(
            "bodies",
            "there is no body".to_owned(),
            "Give at least one.",
        );
    }
    names(network)?;
    for body in network.bodies() {
        finite(&body.name, "inertia", body.inertia)?;
        if body.inertia <= 0.0 {
            let problem = format!("its inertia is {}", body.inertia);
            return refuse(&body.name, problem, "Give a positive inertia or mass.");
        }
    }
    for (name, body) in network.loads() {
        if *body >= network.bodies().len() {
            let problem = format!("it acts on body number {body}, which is not there");
            return refuse(name, problem, "Let it act on a body of the mechanism.");
        }
    }
    for element in network.elements() {
        ends(network, element)?;
        law(element)?;
    }
    connected(network)
}

fn names(network: &Network) -> Result<(), Error> {
    let bodies = network.bodies().iter().map(|b| &b.name);
    let loads = network.loads().iter().map(|(name, _)| name);
    let elements = network.elements().iter().map(|e| &e.name);
    let mut seen: Vec<&str> = vec!["ground"];
    for name in bodies.chain(network.driven()).chain(elements).chain(loads) {
        if name.is_empty() || name.contains('.') {
            let remedy = "Give it a name without a dot: dots part the name from the parameter.";
            return refuse(name, format!("'{name}' is no name"), remedy);
        }
        if seen.contains(&name.as_str()) {
            let remedy = "Give every body, driven node, load and element a name of its own.";
            return refuse(name, "its name is taken".to_owned(), remedy);
        }
        seen.push(name);
    }
    Ok(())
}

fn finite(place: &str, name: &str, value: f64) -> Result<(), Error> {
    if value.is_finite() {
        return Ok(());
    }
    refuse(
        place,
        format!("its {name} is {value}"),
        "Give a finite number.",
    )
}

fn ends(network: &Network, element: &Element) -> Result<(), Error> {
    let assisted = match &element.law {
        Law::Assist { on, .. } => Some(*on),
        _ => None,
    };
    for (end, which) in [(element.a, "ratio_a"), (element.b, "ratio_b")]
        .into_iter()
        .chain(assisted.map(|on| (on, "ratio_on")))
    {
        finite(&element.name, which, end.ratio)?;
        let there = match end.node {
            Node::Ground => true,
            Node::Body(i) => i < network.bodies().len(),
            Node::Driven(i) => i < network.driven().len(),
        };
        if !there {
            let problem = "it is fastened to a node that is not there".to_owned();
            return refuse(
                &element.name,
                problem,
                "Name a body, a driven node or ground.",
            );
        }
        if end.ratio == 0.0 && end.node != Node::Ground {
            let problem = format!("its {which} is 0");
            return refuse(
                &element.name,
                problem,
                "Give a ratio that is not 0, or fasten it to ground.",
            );
        }
    }
    if let Some(End {
        node: Node::Ground | Node::Driven(_),
        ..
    }) = assisted
    {
        let problem = "it acts on a node that is no body".to_owned();
        return refuse(&element.name, problem, "Let it act on a body.");
    }
    if element.a.node == element.b.node {
        let problem = "both its ends are fastened to the same node".to_owned();
        return refuse(
            &element.name,
            problem,
            "Fasten one of them to another node or to ground.",
        );
    }
    let is_body = |end: End| matches!(end.node, Node::Body(_));
    if assisted.is_none() && !is_body(element.a) && !is_body(element.b) {
        let problem = "no body feels it".to_owned();
        return refuse(&element.name, problem, "Fasten one of its ends to a body.");
    }
    Ok(())
}

fn law(element: &Element) -> Result<(), Error> {
    let name = &element.name;
    let positive = |which: &str, value: f64| {
        finite(name, which, value)?;
        if value < 0.0 {
            return refuse(name, format!("its {which} is {value}"), "Give 0 or more.");
        }
        Ok(())
    };
    match &element.law {
        Law::Spring {
            stiffness,
            gap,
            hardening,
        } => {
            positive("stiffness", *stiffness)?;
            positive("gap", *gap)?;
            positive("hardening", *hardening)
        }
        Law::Damper { viscous, drag } => {
            positive("viscous", *viscous)?;
            positive("drag", *drag)
        }
        Law::Friction {
            level,
            difference,
            stribeck,
            stribeck_speed,
            stiction,
        } => {
            positive("level", *level)?;
            finite(name, "difference", *difference)?;
            finite(name, "stribeck", *stribeck)?;
            finite(name, "stribeck_speed", *stribeck_speed)?;
            finite(name, "stiction", *stiction)?;
            if *stiction < 0.0 {
                let problem = format!("static friction is {} below kinetic friction", -stiction);
                let remedy = "Give a static level of at least the kinetic one.";
                return refuse(name, problem, remedy);
            }
            // Friction that drives the motion would be a source of energy.
            if difference.abs() > *level {
                let problem = format!("its difference {difference} exceeds its level {level}");
                let remedy = "Friction in either direction cannot drive the motion.";
                return refuse(name, problem, remedy);
            }
            if *stribeck < difference.abs() - level {
                let problem =
                    format!("its stribeck {stribeck} makes friction at low speed negative");
                return refuse(name, problem, "Give at least minus the level.");
            }
            if *stribeck != 0.0 && *stribeck_speed <= 0.0 {
                let problem = format!("its stribeck_speed is {stribeck_speed}");
                return refuse(
                    name,
                    problem,
                    "Give a positive speed with a stribeck extra.",
                );
            }
            Ok(())
        }
        Law::Assist { scale, terms, .. } => {
            positive("scale", *scale)?;
            for (k, a) in terms {
                finite(name, "curve", *k)?;
                positive("curve", *a)?;
            }
            Ok(())
        }
    }
}

/// Every body must hang on to the others. The ground does not connect: what hangs on to nothing else is a mechanism of
/// its own, and most often a forgotten element.
fn connected(network: &Network) -> Result<(), Error> {
    let bodies = network.bodies().len();
    let place = |end: End| match end.node {
        Node::Body(i) => Some(i),
        Node::Driven(i) => Some(bodies + i),
        Node::Ground => None,
    };
    let mut group: Vec<usize> = (0..bodies + network.driven().len()).collect();
    for element in network.elements() {
        let on = match &element.law {
            Law::Assist { on, .. } => place(*on),
            _ => None,
        };
        let mut joined = [place(element.a), place(element.b), on]
            .into_iter()
            .flatten();
        let Some(to) = joined.next().map(|i| group[i]) else {
            continue;
        };
        for other in joined {
            let from = group[other];
            for g in group.iter_mut().filter(|g| **g == from) {
                *g = to;
            }
        }
    }
    let first = &network.bodies()[0].name;
    let remedy = "Add a spring, damper or friction between them, or leave it out.";
    let names = network.bodies().iter().map(|b| &b.name);
    for (name, own) in names.chain(network.driven()).zip(&group) {
        if *own != group[0] {
            return refuse(name, format!("nothing connects it with {first}"), remedy);
        }
    }
    Ok(())
}
