"""The distance of the body from the edges along a drive, for pictures: the criterion takes its own from the core."""

from __future__ import annotations

import numpy as np

from ..vehicle import Car, Drive
from .track import Track

# Points along each side of the body; between two of them lie some 0.1 m.
POINTS = 41


def along(drive: Drive, track: Track, car: Car) -> np.ndarray:
    """Return the least distance from an edge at every sample, shape (..., n); infinite where there is none.

    Parameters
    ----------
    drive : Drive
    track : Track
    car : Car
    """
    reach = np.linspace(-car["body.rear_end_m"], car["body.front_end_m"], POINTS)
    sin, cos = np.sin(drive.yaw_rad), np.cos(drive.yaw_rad)
    least = np.full(drive.x_m.shape, np.inf)
    for side in (1.0, -1.0):
        half = side * 0.5 * car["body.width_m"]
        for ahead in reach:
            x = drive.x_m + ahead * cos - half * sin
            y = drive.y_m + ahead * sin + half * cos
            for start, end, right, left in track.sections():
                distance = left - y if side > 0.0 else y - right
                here = (x >= start) & (x <= end)
                least = np.where(here & (distance < least), distance, least)
    return least


def outline(x: float, y: float, yaw: float, car: Car) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of the body, closed, shape (5,) each."""
    front, rear, half = car["body.front_end_m"], -car["body.rear_end_m"], 0.5 * car["body.width_m"]
    ahead = np.array([front, front, rear, rear, front])
    aside = np.array([half, -half, -half, half, half])
    return x + ahead * np.cos(yaw) - aside * np.sin(yaw), y + ahead * np.sin(yaw) + aside * np.cos(yaw)
