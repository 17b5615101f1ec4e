"""How fast free runs are: `PYTHONPATH=tests python benches/bench_dynamics.py`.

Lane-steps per second of both kernels with every instruction set, the same split step as a numba loop over all cores
(where numba is installed), and a general solver with events at about the same error. Kernels and peer take turns in one
run; the medians of the rounds are printed, per second of wall time and per second of processor time, which is what
counts on a machine that does other work as well.
"""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable

import numpy as np

from generators.steering import Hand, Mechanism
from generators.steering import simulate as solve_with_events
from luztar.dynamics import simulate

ROUNDS = 7
LANES = 256
RATE_HZ = 1_000.0
# Steps of 0.1 ms of which every tenth is kept: what is measured is the step, not the memory.
SUBSTEPS = 10
SECONDS = 2.0


def mechanisms() -> dict[str, np.ndarray | float]:
    """Return one mechanism per lane, dry friction spread over them."""
    return {
        "steering.inertia_kg_m2": 3.0,
        "steering.ratio": 16.0,
        "steering.stiffness_nm_per_rad": 60.0,
        "freeplay.gap_rad": 0.1,
        "viscous.coefficient_nm_s_per_rad": 40.0,
        "coulomb.level_nm": np.linspace(4.0, 12.0, LANES),
        "stiction.extra_nm": 3.9,
    }


def numba_step() -> Callable[[np.ndarray, np.ndarray, np.ndarray], None] | None:
    """Return the split step as one would write it by hand, or None without numba."""
    try:
        import numba
    except ImportError:
        return None

    @numba.njit(inline="always")
    def torque(psi: float, q: float) -> float:
        z = psi - 16.0 * q
        return 16.0 * 60.0 * (z - min(max(z, -0.05), 0.05))

    @numba.njit(parallel=True)
    def run(psi: np.ndarray, levels: np.ndarray, out: np.ndarray) -> None:
        inertia, mu, extra, h = 3.0, 40.0, 3.9, 1.0 / (RATE_HZ * SUBSTEPS)
        k = h * mu / (2.0 * inertia)
        for lane in numba.prange(levels.size):
            kinetic, q, v = levels[lane], 0.0, 0.0
            static = kinetic + extra
            out[lane, 0] = 0.0
            for i in range(psi.size - 1):
                a, b = psi[i], psi[i + 1]
                middle = q + h * v / 2.0
                s = (v > 0.0) - (v < 0.0)
                v1 = (v * (1.0 - k) + h * (torque(0.5 * (a + b), middle) - kinetic * s) / inertia) / (1.0 + k)
                if v1 * v > 0.0:
                    q, v = middle + h * v1 / 2.0, v1
                else:
                    share = v / (v - v1) if v != 0.0 else 0.0
                    q += share * h * v / 2.0
                    m0, m1 = torque(a + share * (b - a), q), torque(b, q)
                    if abs(m0) > static:
                        stuck, way = 0.0, m0
                    elif abs(m1) > abs(m0):
                        stuck, way = min(max((static - abs(m0)) / (abs(m1) - abs(m0)), 0.0), 1.0), m1
                    else:
                        stuck, way = 1.0, m1
                    left = (1.0 - share) * (1.0 - stuck) * h
                    mean = (m0 + (m1 - m0) * stuck + m1) / 2.0 - math.copysign(kinetic, way)
                    v = left * mean / inertia / (1.0 + left * mu / (2.0 * inertia))
                    if v * way <= 0.0:
                        v = 0.0
                    q += left * v / 2.0
                if (i + 1) % SUBSTEPS == 0:
                    out[lane, (i + 1) // SUBSTEPS] = q

    return run


def main() -> None:
    """Print one line per way."""
    times = np.arange(round(SECONDS * RATE_HZ) + 1) / RATE_HZ
    psi = np.sin(2.0 * math.pi * 0.5 * times)
    given = mechanisms()
    ways: dict[str, Callable[[], object]] = {}
    for method in ("split", "moreau_jean"):
        for width in ("baseline", "avx2", "avx512"):
            ways[f"{method}, {width}"] = lambda m=method, w=width: simulate(
                given, psi, sample_rate_hz=RATE_HZ, substeps=SUBSTEPS, method=m, width=w
            )
    peer = numba_step()
    if peer is None:
        print("numba is not installed: without the hand-written loop")
    else:
        levels, out = np.asarray(given["coulomb.level_nm"]), np.empty((LANES, psi.size))
        fine = np.sin(math.pi * np.arange((psi.size - 1) * SUBSTEPS + 1) / (RATE_HZ * SUBSTEPS))
        ways["split, numba parallel"] = lambda: peer(fine, levels, out)
    wall: dict[str, list[float]] = {name: [] for name in ways}
    busy: dict[str, list[float]] = {name: [] for name in ways}
    for call in ways.values():
        call()
    for _ in range(ROUNDS):
        for name, call in ways.items():
            started, worked = time.perf_counter(), time.process_time()
            call()
            wall[name].append(time.perf_counter() - started)
            busy[name].append(time.process_time() - worked)
    steps = LANES * (psi.size - 1) * SUBSTEPS
    print(f"{LANES} lanes, {(psi.size - 1) * SUBSTEPS} steps, every tenth kept; 10^6 lane-steps/s, medians of {ROUNDS}")
    print(f"{'':<24}{'wall':>10}{'processor':>12}")
    for name in ways:
        shown = [steps / statistics.median(s[name]) / 1e6 for s in (wall, busy)]
        print(f"{name:<24}{shown[0]:>10.0f}{shown[1]:>12.0f}")
    if peer is not None:
        ratio = statistics.median(
            p / w for p, w in zip(wall["split, numba parallel"], wall["split, avx512"], strict=True)
        )
        print(f"numba over luztar (widest), wall, median of ratios: {ratio:.1f}")
    _against_events(times, psi)


def _against_events(times: np.ndarray, psi: np.ndarray) -> None:
    """One lane against scipy's events: seconds of wall time per simulated second, at the errors shown."""
    m = Mechanism(3.0, 16.0, 60.0, 0.0, 40.0, 0.05, 8.1, 12.0)
    hand = Hand((1.0,), (0.5,), ramp_s=1e-9)
    fine = simulate({**mechanisms(), "coulomb.level_nm": 8.1}, psi, sample_rate_hz=RATE_HZ, substeps=2000).roadwheel_rad
    started = time.perf_counter()
    solved = solve_with_events(m, hand, times, tolerance=1e-8)
    slow = time.perf_counter() - started
    print(
        f"solve_ivp with events: {1e3 * slow / SECONDS:.0f} ms per simulated s, error {np.abs(solved - fine).max():.1e}"
    )
    seconds = []
    for _ in range(ROUNDS):
        started = time.perf_counter()
        many = simulate(mechanisms(), psi, sample_rate_hz=RATE_HZ)
        seconds.append((time.perf_counter() - started) / LANES)
    lane = int(np.argmin(np.abs(np.asarray(mechanisms()["coulomb.level_nm"]) - 8.1)))
    parts = {k: (float(v[lane]) if isinstance(v, np.ndarray) else v) for k, v in mechanisms().items()}
    exact = simulate(parts, psi, sample_rate_hz=RATE_HZ, substeps=2000).roadwheel_rad
    error = np.abs(many.roadwheel_rad[lane] - exact).max()
    each = statistics.median(seconds)
    print(f"split at 1 ms, a lane of {LANES}: {1e3 * each / SECONDS:.4f} ms per simulated s, error {error:.1e}")


if __name__ == "__main__":
    main()
