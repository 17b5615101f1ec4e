"""Which frictions hold: optimality on random networks, the two solvers against each other, static indeterminacy."""

import numpy as np
import pytest
from scipy.optimize import linprog, lsq_linear

from luztar import _core
from luztar.mechanism import Body, Driven, Friction, Load, Mechanism, Spring, simulate
from mechanism_parts import chain, push

# Relative to the largest term of a condition: what the task of the solver is.
OPTIMAL = 1e-10


def random_network(rng: np.random.Generator, *, steering: bool) -> tuple[np.ndarray, ...]:
    """Five bodies and nine contacts: each body on the ground, and four pairs; bounds from a static level."""
    inertia = np.array([10.2, 0.3, 0.5, 1.5, 1.5]) if steering else np.ones(5)
    directions = np.zeros((5, 9))
    directions[:, :5] = np.eye(5)
    for column in range(5, 9):
        a, b = rng.choice(5, 2, replace=False)
        directions[a, column], directions[b, column] = 1.0, -1.0
    level = rng.uniform(0.1, 1.0, 9)
    force = rng.normal(0.0, 1.5, 5)
    matrix = directions.T @ (directions / inertia[:, None])
    return inertia, directions, level, force, matrix, directions.T @ (force / inertia)


@pytest.mark.parametrize("steering", [False, True], ids=["equal", "steering"])
def test_random_networks_meet_the_conditions_of_optimality(steering):
    rng = np.random.default_rng(5)
    sets, cycled = [], 0
    for _ in range(400):
        inertia, directions, level, force, matrix, free = random_network(rng, steering=steering)
        torque, slack, tried, sweeps, solved = _core.hold_or_slide(matrix, free, -level, level, False)
        torque, slack = np.array(torque), np.array(slack)
        assert solved
        sets.append(tried)
        cycled += sweeps > 0
        size = np.abs(free) + np.abs(matrix) @ np.abs(torque)
        np.testing.assert_allclose(slack, free - matrix @ torque, atol=OPTIMAL * size.max())
        assert np.all(np.abs(torque) <= level * (1.0 + OPTIMAL))
        inside = np.abs(torque) < level * (1.0 - OPTIMAL)
        assert np.all(np.abs(slack[inside]) <= OPTIMAL * size[inside])
        assert np.all(slack * np.sign(torque) >= -OPTIMAL * size)
        # The motion is unique: a bounded least-squares solver of another make finds the same.
        root = np.sqrt(inertia)
        other = lsq_linear(directions / root[:, None], force / root, (-level, level), method="bvls", tol=1e-14)
        np.testing.assert_allclose(directions @ torque, directions @ other.x, atol=1e-8)
        swept, *_, solved = _core.hold_or_slide(matrix, free, -level, level, True)
        assert solved
        np.testing.assert_allclose(directions @ np.array(swept), directions @ torque, atol=1e-9)
    assert np.median(sets) <= 5 and cycled < 40


def test_a_forced_gauss_seidel_gives_the_same_run():
    m = chain(between=0.5, static=1.3)
    t = np.arange(3001) / 1000.0
    runs = [
        simulate(m, {"push": push(t)}, sample_rate_hz=1000.0, substeps=1, solver=solver)
        for solver in ("active_set", "gauss_seidel")
    ]
    for body in ("one", "two"):
        np.testing.assert_allclose(runs[0].position[body], runs[1].position[body], atol=1e-12)
    assert [(e.kind, e.element) for e in runs[0].events] == [(e.kind, e.element) for e in runs[1].events]


def three_contacts(**changes: object) -> Mechanism:
    return Mechanism(
        bodies=(Body("one", 1.0), Body("two", 2.0)),
        loads=(Load("f1", "one"), Load("f2", "two")),
        elements=(
            Friction("t1", "one", kinetic=0.02),
            Friction("t2", "two", kinetic=0.02),
            Friction("t12", "two", "one", kinetic=0.01),
        ),
        **changes,
    )


def test_two_bodies_on_three_contacts_have_a_unique_rest_and_many_splits():
    """The example of the reference: (.010, .004, 0) and (.020, -.006, .010) both hold it."""
    n = 200
    run = simulate(three_contacts(), {"f1": np.full(n, 0.010), "f2": np.full(n, 0.004)}, sample_rate_hz=100.0)
    assert not any(run.speed[b].any() or run.position[b].any() for b in ("one", "two"))
    found = run.indeterminate
    assert found is not None and found.undetermined == ("t1", "t2", "t12")
    np.testing.assert_allclose(
        [found.interval[k] for k in ("t1", "t2", "t12")],
        [(0.0, 0.020), (-0.006, 0.014), (-0.010, 0.010)],
        atol=1e-12,
    )
    for split in ((0.010, 0.004, 0.0), (0.020, -0.006, 0.010)):
        assert all(
            found.interval[k][0] - 1e-12 <= v <= found.interval[k][1] + 1e-12
            for k, v in zip(("t1", "t2", "t12"), split, strict=True)
        )
    # Along t = (0.010 + s, 0.004 - s, s) the norm is least at s = -0.002.
    np.testing.assert_allclose([found.least_norm[k] for k in ("t1", "t2", "t12")], (0.008, 0.006, -0.002), atol=1e-12)
    assert "motion is unique" in str(run) and found.to_dict()["interval"]["t12"] == pytest.approx([-0.01, 0.01])
    assert run.torque["t1"][-1] - run.torque["t12"][-1] == pytest.approx(0.010, abs=1e-15)


def test_the_least_norm_stays_admissible_where_the_box_cuts_it_off():
    n = 50
    m = three_contacts().with_parameters({"t2.kinetic_nm": 0.005})
    found = simulate(m, {"f1": np.full(n, 0.010), "f2": np.full(n, 0.004)}, sample_rate_hz=100.0).indeterminate
    # s = -0.002 would ask 0.006 of t2; at its limit of 0.005, s is -0.001.
    np.testing.assert_allclose([found.least_norm[k] for k in ("t1", "t2", "t12")], (0.009, 0.005, -0.001), atol=1e-12)


def test_what_breaks_loose_together_does_so_when_no_split_holds_any_more():
    """A ramp on one body of two that friction joins: all holds until the sum of what can hold it is used up."""
    n = 4001
    t = np.arange(n) / 1000.0
    run = simulate(three_contacts(), {"f1": 0.01 * t}, sample_rate_hz=1000.0, substeps=1)
    # Body one can be held by t1 (0.02) and by t12 (0.01) as long as t2 holds the other.
    assert [e.element for e in run.events] == ["t1", "t12"] and {e.kind for e in run.events} == {"slip"}
    assert all(e.time_s == pytest.approx(3.0, abs=1e-9) for e in run.events)
    # From then on it slides by the closed form q = al tau^3 / (6 I).
    assert run.position["one"][-1] == pytest.approx(0.01 * 1.0**3 / 6.0, rel=1e-5)
    assert not run.position["two"].any()


def test_one_contact_between_two_free_bodies_carries_what_moves_them_together():
    """T12 = clip((m2 F1 - m1 F2) / (m1 + m2), F12)."""
    m = Mechanism(
        bodies=(Body("one", 2.0), Body("two", 3.0)),
        loads=(Load("f1", "one"), Load("f2", "two")),
        elements=(Friction("t12", "one", "two", kinetic=0.5),),
    )
    n = 101
    for f1, f2 in ((1.0, 0.4), (1.0, -0.2), (3.0, 0.0), (-4.0, 1.0)):
        run = simulate(m, {"f1": np.full(n, f1), "f2": np.full(n, f2)}, sample_rate_hz=100.0)
        wanted = float(np.clip((3.0 * f1 - 2.0 * f2) / 5.0, -0.5, 0.5))
        assert run.torque["t12"][0] == pytest.approx(wanted, abs=1e-14)
        for body, force, mass in (("one", f1 - wanted, 2.0), ("two", f2 + wanted, 3.0)):
            assert run.position[body][-1] == pytest.approx(0.5 * force / mass, rel=1e-12)
        together = abs(wanted) < 0.5
        assert (run.speed["one"] == run.speed["two"]).all() == together
        assert (run.sliding["t12"] == 0).all() == together


def test_a_body_that_a_driven_node_drags_has_its_speed_exactly():
    m = Mechanism(
        bodies=(Body("mass", 1.0, "m"),),
        driven=(Driven("belt", "m"),),
        elements=(Friction("rub", "mass", "belt", kinetic=2.0, unit="m"),),
    )
    t = np.arange(501) / 500.0
    belt = 0.3 * t + 0.05 * np.sin(3.0 * t)
    run = simulate(m, {"belt": belt}, sample_rate_hz=500.0, start_speed={"mass": 0.45})
    # The start differs from the belt's speed by what its first parabola does.
    assert (run.sliding["rub"][1:] == 0).all()
    # The parabola of the first interval is of third order.
    np.testing.assert_allclose(run.position["mass"], belt, atol=1e-8)
    # Differences of the samples, of second order.
    np.testing.assert_allclose(run.torque["rub"][5:-5], 0.45 * np.sin(3.0 * t)[5:-5], atol=1e-5)
    assert run.energy_j["belt"] == pytest.approx(0.5 * (run.speed["mass"][-1] ** 2 - 0.45**2), abs=1e-5)


@pytest.mark.parametrize("seed", range(6))
def test_intervals_against_the_vertices_of_the_polytope(seed):
    """Four frictions too many: each end is what a linear programme with other variables finds."""
    rng = np.random.default_rng(seed)
    elements = [Friction(f"g{i}", f"b{i}", kinetic=rng.uniform(0.2, 1.0)) for i in range(3)]
    pairs = [("b0", "b1"), ("b1", "b2"), ("b0", "b2")]
    elements += [Friction(f"p{i}", a, b, kinetic=rng.uniform(0.2, 1.0)) for i, (a, b) in enumerate(pairs)]
    loads = {f"f{i}": rng.uniform(-0.3, 0.3) for i in range(3)}
    m = Mechanism(
        bodies=tuple(Body(f"b{i}", 1.0 + i) for i in range(3)),
        loads=tuple(Load(f"f{i}", f"b{i}") for i in range(3)),
        elements=tuple(elements),
    )
    run = simulate(m, {k: np.full(3, v) for k, v in loads.items()}, sample_rate_hz=100.0)
    found = run.indeterminate
    assert found is not None
    w = np.array([[1, 0, 0, 1, 0, 1], [0, 1, 0, -1, 1, 0], [0, 0, 1, 0, -1, -1]], dtype=float)
    limit = np.array([e.kinetic for e in elements])
    names = [e.name for e in elements]
    # t = limit (2 u - 1): shifted, scaled variables.
    a, b = w * (2.0 * limit), np.array(list(loads.values())) + w @ limit
    for i, name in enumerate(names):
        ends = []
        for sign in (1.0, -1.0):
            goal = sign * np.eye(6)[i]
            ends.append(limit[i] * (2.0 * linprog(goal, A_eq=a, b_eq=b, bounds=(0.0, 1.0)).x[i] - 1.0))
        np.testing.assert_allclose(found.interval[name], sorted(ends), atol=1e-9)
    # Least norm: no admissible direction lowers it.
    least = np.array([found.least_norm[n] for n in names])
    np.testing.assert_allclose(w @ least, list(loads.values()), atol=1e-12)
    assert np.all(np.abs(least) <= limit * (1.0 + 1e-12))
    null = np.linalg.svd(w)[2][3:]
    for _ in range(200):
        other = least + null.T @ rng.normal(0.0, 0.1, 3)
        if np.all(np.abs(other) <= limit):
            assert other @ other >= least @ least - 1e-12


def test_a_spring_between_two_that_stick_keeps_its_torque():
    m = Mechanism(
        bodies=(Body("one", 1.0), Body("two", 1.0)),
        elements=(
            Spring("k", "one", "two", stiffness=5.0),
            Friction("f1", "one", kinetic=1.0),
            Friction("f2", "two", kinetic=1.0),
        ),
    )
    run = simulate(m, sample_rate_hz=100.0, seconds=10.0, start={"one": 0.1, "two": -0.05})
    assert (run.torque["k"] == run.torque["k"][0]).all() and run.events == ()
    assert run.torque["k"][0] == pytest.approx(0.75, abs=1e-15)
