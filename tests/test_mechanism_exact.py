"""The step against the exact solution of bodies with friction on their own coordinates, event by event."""

import numpy as np

from luztar.dynamics import GapSpring, Signal, exact_bodies
from luztar.mechanism import Damper, Friction, Mechanism, Spring, simulate, steering_mechanism
from mechanism_parts import STEPS, chain, observed_order


def exact(m: Mechanism, times_s: np.ndarray, drives: dict[str, Signal], start: dict[str, float]) -> np.ndarray:
    """The same mechanism in the terms of the exact solver, put together here from its parts."""
    names = [b.name for b in m.bodies]
    n = len(names)
    damping, springs = np.zeros((n, n)), []
    kinetic, static = np.zeros(n), np.zeros(n)
    for e in m.elements:
        row, end = np.zeros(n), 0.0
        for node, share in ((e.a, e.ratio_a), (e.b, -e.ratio_b)):
            if node in names:
                row[names.index(node)] += share
            elif node in drives:
                end = drives[node]
        if isinstance(e, Spring):
            # luz(end - at . q): the row turned round.
            springs.append(GapSpring(e.stiffness, e.gap, (-row).tolist(), end))
        elif isinstance(e, Damper):
            damping += e.viscous * np.outer(row, row)
        elif isinstance(e, Friction):
            i = names.index(e.a)
            kinetic[i] += e.kinetic
            static[i] += e.kinetic if e.static is None else e.static
    loads = [0.0] * n
    for load in m.loads:
        if load.name in drives:
            loads[names.index(load.on)] = drives[load.name]
    run = exact_bodies(
        [b.inertia for b in m.bodies],
        times_s,
        damping=damping,
        kinetic=kinetic,
        static=static,
        loads=loads,
        springs=springs,
        start=[start.get(name, 0.0) for name in names],
    )
    return run.angle


def test_the_chain_goes_the_exact_way_at_order_two():
    m = chain(static=1.4)
    load = Signal.sine(1.6, 2.3) + Signal.sine(1.1, 5.2)
    truth = exact(m, np.array([0.0, 1.0, 2.0, 3.0]), {"push": load}, {"one": 0.05})
    errors = []
    for n in STEPS:
        n -= n % 3
        t = np.arange(n + 1) * (3.0 / n)
        run = simulate(m, {"push": load(t)}, sample_rate_hz=n / 3.0, substeps=1, start={"one": 0.05})
        found = np.stack([run.position[b][:: n // 3] for b in ("one", "two")])
        errors.append(float(np.abs(found - truth).max()))
    assert observed_order(errors) >= 1.9, errors
    assert errors[-1] < 2e-6


def test_the_papers_mechanism_goes_the_exact_way():
    """Figure 3 with freeplay and static above kinetic friction: four bodies, a gear of 2000 rad/s."""
    m = steering_mechanism(king_pin_static_nm=6.0, rack_static_n=150.0)
    psi = Signal.sine(1.0, 4.3)
    times = np.linspace(0.0, 1.0, 5)
    truth = exact(m, times, {"handwheel": psi}, {})
    sizes = np.abs(truth).max(axis=1, keepdims=True)
    errors = []
    for n in (20_000, 80_000):
        t = np.arange(n + 1) / n
        run = simulate(m, {"handwheel": psi(t)}, sample_rate_hz=float(n), substeps=1)
        found = np.stack([run.position[b.name][:: n // 4] for b in m.bodies])
        errors.append(float((np.abs(found - truth) / sizes).max()))
    # Second order: a quarter of the step, a sixteenth of the error, with room for where in a step events lie.
    assert errors[0] < 1e-3 and errors[1] < errors[0] / 8.0, errors
