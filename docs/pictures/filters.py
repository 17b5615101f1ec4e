"""Draws the pictures of which-filter.md: orders, cut-offs, edges and fixed lag. Needs matplotlib.

``python docs/pictures/filters.py`` from the top of the repository.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")

from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402

from luztar import signal  # noqa: E402

BLUE, ORANGE, GREY, GREEN = "#2458a6", "#c8641b", "#9aa3ad", "#3d8b57"
FOLDER = Path(__file__).parent
RATE_HZ = 1000.0


def decibel(magnitude: np.ndarray) -> np.ndarray:
    """Return 20 log10, without a warning at zero."""
    return 20 * np.log10(np.maximum(magnitude, 1e-12))


def orders() -> Figure:
    """Four filters that are all called fourth order."""
    f = np.geomspace(1, 60, 400)
    figure, axes = plt.subplots(figsize=(7.2, 3.6))
    four_and_four = signal.LowPass(poles=4, cutoff_hz=6, sample_rate_hz=RATE_HZ)
    four = signal.LowPass(poles=4, cutoff_hz=6, sample_rate_hz=RATE_HZ, zero_phase=False)
    drawn = (
        (four, BLUE, "-", "4 poles forward: 4-pole slope, -3.01 dB, late"),
        (signal.tb038(RATE_HZ), GREEN, "-", "2 + 2 poles, cut-off overall: 4-pole slope, -3.01 dB"),
        (signal.LowPass(poles=2, cutoff_hz=6, sample_rate_hz=RATE_HZ), GREY, "-", "2 + 2 poles, per pass: -6.02 dB"),
        (four_and_four, ORANGE, "-", "4 + 4 poles, per pass: 8-pole slope, -6.02 dB"),
    )
    for made, colour, style, label in drawn:
        axes.semilogx(f, decibel(np.abs(made.response(f))), style, color=colour, label=label)
    axes.axvline(6, color=GREY, lw=0.8, ls=":")
    axes.set(ylim=(-80, 3), xlim=(1, 60), xlabel="frequency [Hz]", ylabel="magnitude [dB]")
    axes.set_xticks([1, 2, 6, 10, 20, 60], ["1", "2", "6", "10", "20", "60"])
    axes.minorticks_off()
    axes.legend(frameon=False, loc="lower left")
    return figure


def cutoffs() -> Figure:
    """Where two passes put their -3 dB point, and what the usual correction leaves."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.2, 3.2))
    f = np.linspace(3, 9, 300)
    for cutoff_at, colour in (("per_pass", ORANGE), ("overall", BLUE)):
        made = signal.LowPass(poles=2, cutoff_hz=6, sample_rate_hz=RATE_HZ, cutoff_at=cutoff_at)
        left.plot(f, decibel(np.abs(made.response(f))), color=colour, label=f'cutoff_at="{cutoff_at}"')
    left.axhline(-3.0103, color=GREY, lw=0.8, ls=":")
    left.axvline(6, color=GREY, lw=0.8, ls=":")
    left.annotate("4.81 Hz", (4.81, -3.01), (3.1, -4.6), color=ORANGE, arrowprops={"arrowstyle": "-", "color": ORANGE})
    left.set(title="2 + 2 poles asked for 6 Hz", xlabel="frequency [Hz]", ylabel="magnitude [dB]", ylim=(-12, 0.3))
    left.legend(frameon=False, loc="lower left")
    ratio = np.linspace(0.005, 0.3, 120)
    factor = (np.sqrt(2) - 1) ** 0.25
    usual, exact = [], []
    for r in ratio:
        usual.append(signal.LowPass(poles=2, cutoff_hz=min(r / factor, 0.4999), sample_rate_hz=1).magnitude(r))
        exact.append(signal.LowPass(poles=2, cutoff_hz=r, sample_rate_hz=1, cutoff_at="overall").magnitude(r))
    right.plot(ratio, decibel(np.array(usual)), color=ORANGE, label="cut-off divided by 0.8022")
    right.plot(ratio, decibel(np.array(exact)), color=BLUE, label="its tangent divided (luztar)")
    right.set(title="level at the cut-off asked for", xlabel="cut-off / sample rate", ylabel="magnitude [dB]")
    right.legend(frameon=False, loc="upper left")
    figure.tight_layout()
    return figure


def sine(n: int, margin: int = 0) -> np.ndarray:
    """Return 20 units at 2 Hz, with what came before and after the record."""
    return 20 * np.sin(2 * np.pi * 2 * np.arange(-margin, n + margin) / RATE_HZ + 0.6)


def edges() -> Figure:
    """Both ends of a record: the truth, ours and scipy's."""
    n, margin = 1000, 20_000
    given = {"sample_rate_hz": RATE_HZ, "cutoff_hz": 6}
    x, truth = sine(n), signal.zero_phase(sine(n, margin), **given)[margin:-margin]
    t = np.arange(n) / RATE_HZ
    figure, (above, below) = plt.subplots(2, 1, figsize=(7.2, 4.6), sharex=True, height_ratios=(2, 1))
    above.plot(t, truth, color=GREY, lw=4, alpha=0.6, label="the filter on the longer signal")
    for name, colour, label in (("scipy", ORANGE, 'edges="scipy": 15 samples'), ("settled", BLUE, 'edges="settled"')):
        y = signal.zero_phase(x, **given, edges=name)
        above.plot(t, y, color=colour, lw=1.4, label=label)
        below.semilogy(t, np.maximum(np.abs(y - truth), 1e-7), color=colour)
    above.set(ylabel="unit", title="2 Hz sine through 4 + 4 poles at 6 Hz, one second at 1 kHz")
    above.legend(frameon=False, loc="lower center", ncols=3, bbox_to_anchor=(0.5, -0.22))
    below.set(ylabel="error", xlabel="time [s]", ylim=(1e-4, 30))
    figure.tight_layout()
    return figure


def fixed_lag() -> Figure:
    """Live results beside the record's, and how the bound falls with the delay."""
    design = signal.LowPass(poles=4, cutoff_hz=6, sample_rate_hz=RATE_HZ)
    causal = signal.Filter(poles=4, cutoff_hz=6, sample_rate_hz=RATE_HZ)
    x = 0.2 * np.cumsum(np.random.default_rng(3).standard_normal(20_000))
    truth = signal.zero_phase(x, design=design)
    t = np.arange(x.size) / RATE_HZ
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.2, 3.2), width_ratios=(3, 2))
    shown = slice(10_000, 11_200)
    left.plot(t[shown], x[shown], color=GREY, lw=0.7, label="torque")
    left.plot(t[shown], causal.push(x)[shown], color=ORANGE, label="causal")
    left.plot(t[shown], truth[shown], color=GREEN, lw=4, alpha=0.5, label="zero phase, afterwards")
    live = signal.FixedLag(design, 0.3).push(x)[300:]
    left.plot(t[shown], live[shown], color=BLUE, lw=1.2, label="fixed lag of 0.3 s, put back")
    left.set(xlabel="time [s]", ylabel="unit")
    left.legend(frameon=False, fontsize=7)
    # The filter remembers less than two seconds: no farther can the torque get from its newest sample.
    moved = max(np.ptp(x[i : i + 2000]) for i in range(0, x.size, 100))
    delays = np.linspace(0.05, 1.5, 30)
    bounds, found = [], []
    for delay_s in delays:
        filter_ = signal.FixedLag(design, delay_s)
        lag = filter_.delay_samples
        bounds.append(filter_.error_bound * moved)
        found.append(np.abs(filter_.push(x)[lag + 4000 : -4000] - truth[4000 : -4000 - lag]).max())
    right.semilogy(delays, bounds, color=GREY, label="error_bound x range in 2 s")
    right.semilogy(delays, found, ".", color=BLUE, label="largest error found")
    right.set(xlabel="delay [s]", ylabel="unit")
    right.legend(frameon=False, fontsize=7)
    figure.tight_layout()
    return figure


def main() -> None:
    """Draw them all."""
    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "figure.dpi": 120})
    for picture in (orders, cutoffs, edges, fixed_lag):
        figure = picture()
        figure.savefig(FOLDER / f"filter_{picture.__name__}.png", bbox_inches="tight", metadata={"Software": None})
        plt.close(figure)


if __name__ == "__main__":
    main()
