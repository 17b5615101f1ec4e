"""The free decay as MuJoCo has it: a hinge with stiffness and friction loss. It has no gear with freeplay."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .problems import GRID_S, Problem

MODEL = """<mujoco>
  <option timestep="{step}" gravity="0 0 0"/>
  <worldbody><body>
    <joint type="hinge" axis="0 0 1" stiffness="{stiffness}" frictionloss="{level}" {friction}/>
    <inertial pos="0 0 0" mass="1" diaginertia="1 1 {inertia}"/>
  </body></worldbody>
</mujoco>"""


def available() -> bool:
    """Return whether MuJoCo is installed."""
    try:
        import mujoco  # noqa: F401
    except ImportError:
        return False
    return True


def joint(p: Problem, step_s: float, *, tuned: bool) -> Callable[[], np.ndarray]:
    """Return a call that runs the joint and returns the angle at the grid's instants.

    Tuned is the stiffest that the constraint takes: a time constant of two steps and an impedance of nearly 1.
    """
    import mujoco

    friction = f'solreffriction="{2.0 * step_s!r} 1" solimpfriction="0.9999 0.9999 0.001"' if tuned else ""
    text = MODEL.format(
        step=repr(step_s),
        stiffness=repr(p.parameters["steering.stiffness_nm_per_rad"]),
        level=repr(p.parameters["coulomb.level_nm"]),
        inertia=repr(p.parameters["steering.inertia_kg_m2"]),
        friction=friction,
    )
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    every = round(GRID_S / step_s)

    def run() -> np.ndarray:
        mujoco.mj_resetData(model, data)
        data.qpos[0] = p.start_rad
        out = np.empty(p.times_s.size)
        out[0] = p.start_rad
        for i in range(1, out.size):
            mujoco.mj_step(model, data, nstep=every)
            out[i] = data.qpos[0]
        return out

    return run
