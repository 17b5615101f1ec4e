"""A mechanism in a loop: one step at a time."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any, Self

import numpy as np

from .. import _core
from .._arrays import vector
from .._stream import Stream
from ..errors import ParameterError
from . import drives as door
from .file import as_tables, from_tables
from .mechanism import Mechanism


class Stepper(Stream):
    """A mechanism that is stepped from outside, for a loop in real time.

    Between two steps a channel follows the parabola through its last two values and the new one: nothing is known
    ahead. A step allocates nothing in the core and its cost is bounded: events are located as often as frictions can in
    turn, the rest of such a step is one step of Moreau and Jean.

    Parameters
    ----------
    mechanism : Mechanism
    step_s : float, > 0
        Seconds between two calls of :meth:`step`.
    channels : array_like, shape (c,), optional
        Present values of :attr:`Mechanism.channels`; 0 where none are given.
    start, start_speed : mapping of str to float, optional
        Of bodies.
    substeps : int, optional
        Steps of the core per call; where not given, as many as keep a step below a tenth of the longest
        that the springs allow (:attr:`Mechanism.longest_step_s`).

    Raises
    ------
    ParameterError
        As :func:`simulate`.

    Examples
    --------
    >>> from luztar.mechanism import Stepper, single_mass
    >>> slider = Stepper(single_mass(kinetic=1.0), 1e-3)
    >>> for _ in range(1000):
    ...     slider.step([0.49])
    >>> slider.position.tolist(), slider.speed.tolist()
    ([0.0], [0.0])
    """

    __slots__ = ("_core", "_mechanism", "_settings", "_step", "position", "speed")

    def __init__(
        self,
        mechanism: Mechanism,
        step_s: float,
        *,
        channels: Any = None,
        start: Mapping[str, float] | None = None,
        start_speed: Mapping[str, float] | None = None,
        substeps: int | None = None,
    ) -> None:
        width = len(mechanism.channels)
        first = np.zeros(width) if channels is None else vector("channels", channels, minimum=0)
        if first.size != width:
            known = ", ".join(mechanism.channels) or "none"
            raise ParameterError(f"channels has {first.size} values", "channels", f"Give one for each of: {known}.")
        step = door.positive("step_s", step_s)
        parts = door.parts(mechanism, step, substeps)
        places, speeds = (
            door.by_body(name, mechanism, values) for name, values in (("start", start), ("start_speed", start_speed))
        )
        core = _core.MechanismStepper(mechanism._network, step, parts, places.tolist(), speeds.tolist(), first.tolist())
        self._hold(mechanism, (step, parts), core)

    def _hold(self, mechanism: Mechanism, settings: tuple[float, int], core: _core.MechanismStepper) -> Self:
        self._mechanism, self._settings, self._core, self._step = mechanism, settings, core, core.step
        self.position, self.speed = np.empty(len(mechanism.bodies)), np.empty(len(mechanism.bodies))
        core.read_into(self.position, self.speed)
        return self

    @property
    def mechanism(self) -> Mechanism:
        """The mechanism."""
        return self._mechanism

    @property
    def time_s(self) -> float:
        """Seconds since the start."""
        return self._core.time_s

    @property
    def sliding(self) -> tuple[int, ...]:
        """For each friction that can resist 0 where it holds, else the direction in which it slides."""
        return tuple(self._core.modes())

    def step(self, channels: Any) -> None:
        """Go to the instant at which the channels have these values.

        ``position`` and ``speed``, arrays of the bodies in their order, are then new; a body that friction holds has a
        speed of exactly 0.

        Parameters
        ----------
        channels : array_like, shape (c,)
            Positions of driven nodes, then loads. A float64 vector is used as it lies.

        Raises
        ------
        ParameterError
            A value that is not finite, or a wrong number of them: the state is as it was. A motion that grows beyond
            all bounds.
        """
        if type(channels) is not np.ndarray or channels.dtype != np.float64 or not channels.flags.c_contiguous:
            channels = vector("channels", channels, minimum=0)
        self._step(channels, self.position, self.speed)
        # The sum of what is finite is finite, short of the end of the doubles: one look for all of them.
        if not math.isfinite(self.speed.sum()):
            raise ParameterError(
                f"at {self.time_s:g} s the motion has grown beyond all bounds",
                "step_s",
                "Make the stepper anew with a shorter step: drag, hardening and assistance ask for it at high speed.",
            )

    def torque(self, element: str) -> float:
        """Return the torque or force along an element; of a friction that holds the one of equilibrium.

        Raises
        ------
        ParameterError
            There is no such element.
        """
        names = [e.name for e in self._mechanism.elements]
        if element not in names:
            raise ParameterError(f"there is no element '{element}'", "element", f"Known are: {', '.join(names)}.")
        torques = np.empty(len(names))
        self._core.torques_into(torques)
        return float(torques[names.index(element)])

    def copy(self) -> Self:
        """Return an independent stepper that stands where this one does."""
        return type(self).__new__(type(self))._hold(self._mechanism, self._settings, self._core.copy())

    __copy__ = copy

    def state(self) -> tuple[list[int], list[float]]:
        """Return where it stands, for :meth:`restore` of a stepper of the same mechanism."""
        return self._core.state()

    def restore(self, integers: list[int], numbers: list[float]) -> None:
        """Go back to a state.

        Raises
        ------
        ParameterError
            Not a state of this mechanism; this one is then as it was.
        """
        self._core.restore(integers, numbers)
        self._core.read_into(self.position, self.speed)

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuilt, (self._mechanism, *self._settings, *self.state())

    def to_state(self) -> dict[str, Any]:
        """Return everything as JSON values, the mechanism included."""
        integers, numbers = self.state()
        step_s, substeps = self._settings
        return {
            "schema": 1,
            "kind": "Stepper",
            "mechanism": as_tables(self._mechanism),
            "step_s": step_s,
            "substeps": substeps,
            "integers": integers,
            "numbers": numbers,
        }

    @classmethod
    def from_state(cls, state: dict[str, Any]) -> Self:
        """Return a stepper that goes on where the stored one stood.

        Raises
        ------
        ParameterError
            Not the state of a stepper.
        """
        try:
            if (state["schema"], state["kind"]) != (1, "Stepper"):
                raise ParameterError(
                    f"state is of a {state['kind']}, schema {state['schema']}", "state", "Give one of a Stepper."
                )
            mechanism = from_tables(json.loads(json.dumps(state["mechanism"])))
            made = cls(mechanism, state["step_s"], substeps=state["substeps"])
            made.restore(list(state["integers"]), [float(v) for v in state["numbers"]])
        except (KeyError, TypeError, OverflowError) as wrong:
            raise ParameterError(f"state is not one of to_state() ({wrong!r})", "state", "Store it anew.") from None
        return made


def _rebuilt(mechanism: Mechanism, step_s: float, substeps: int, integers: list[int], numbers: list[float]) -> Stepper:
    made = Stepper(mechanism, step_s, substeps=substeps)
    made.restore(integers, numbers)
    return made
