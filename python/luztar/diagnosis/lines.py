"""Spectral lines in what a model leaves: a disturbance of its own frequency, whatever the motion does.

A sine and a cosine of time are correlated with the residual, stroke by stroke, at every frequency from slower than a
stroke's own changes up to the band's upper edge, in steps of half a line's width. All frequencies at once are a chirp
transform of every stroke, so that the cost grows with the samples and not with samples times frequencies.

Source: Bluestein 1970, A linear filtering approach to the computation of the discrete Fourier transform, IEEE Trans.
Audio Electroacoustics 18:451.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

# Slower than this is what a stroke does anyway; half a line's width between two frequencies.
SLOWEST_LINE_HZ = 0.3
LINES_PER_WIDTH = 2.0


def line_frequencies_hz(longest_s: float, band_hz: float) -> np.ndarray:
    """Return the frequencies at which lines are looked for."""
    return np.arange(SLOWEST_LINE_HZ, band_hz, 1.0 / (LINES_PER_WIDTH * longest_s))


def transform(values: np.ndarray, step_s: float, frequencies_hz: np.ndarray) -> np.ndarray:
    """Return ``sum_k values[..., k] exp(2 pi i f k step)`` for equally spaced frequencies.

    Parameters
    ----------
    values : ndarray, shape (..., n)
    step_s : float
    frequencies_hz : ndarray, shape (m,)

    Returns
    -------
    ndarray of complex, shape (..., m)
    """
    n, m = values.shape[-1], frequencies_hz.size
    if m == 0:
        return np.zeros((*values.shape[:-1], 0), complex)
    spacing = float(frequencies_hz[1] - frequencies_hz[0]) if m > 1 else 0.0
    k = np.arange(max(n, m))
    # f_j t_k = f_0 t_k + spacing step (j^2 + k^2 - (j - k)^2) / 2
    chirp = np.exp(1j * np.pi * spacing * step_s * k**2)
    length = 1 << int(np.ceil(np.log2(n + m - 1)))
    kernel = np.zeros(length, complex)
    kernel[:m] = chirp[:m].conj()
    kernel[length - n + 1 :] = chirp[1:n][::-1].conj()
    turned = values * (np.exp(2j * np.pi * frequencies_hz[0] * step_s * k[:n]) * chirp[:n])
    convolved = np.fft.ifft(np.fft.fft(turned, length) * np.fft.fft(kernel))
    return convolved[..., :m] * chirp[:m]


def line_scores(
    runs: Sequence[tuple[np.ndarray, np.ndarray, np.ndarray, float]], products: np.ndarray, frequencies_hz: np.ndarray
) -> np.ndarray:
    """Return how every stroke's residual goes with every line, the model's own columns taken off the lines.

    Parameters
    ----------
    runs : sequence of (owner, residual, basis, step_s)
        Per run, zero where a sample is left out: the stroke of every sample, shape (n,); the residual, shape (n,); an
        orthonormal basis of the model's columns over all runs, shape (n, p). Both as a line meets them, whitened.
    products : ndarray, shape (strokes, p)
        Of every stroke's residual with the basis.
    frequencies_hz : ndarray, shape (m,)

    Returns
    -------
    ndarray, shape (strokes, 2 m)
        Sine and cosine of each frequency, next to each other.
    """
    along = np.zeros((products.shape[1], frequencies_hz.size), complex)
    direct = np.zeros((products.shape[0], frequencies_hz.size), complex)
    for owner, residual, basis, step_s in runs:
        along += transform(basis.T, step_s, frequencies_hz)
        for stroke in np.unique(owner[owner >= 0]):
            inside = np.flatnonzero(owner == stroke)
            part = slice(inside[0], inside[-1] + 1)
            here = np.where(owner[part] == stroke, residual[part], 0.0)
            late = np.exp(2j * np.pi * frequencies_hz * step_s * inside[0])
            direct[stroke] = transform(here, step_s, frequencies_hz) * late
    scores = direct - products @ along
    return np.stack([scores.imag, scores.real], axis=2).reshape(products.shape[0], -1)
