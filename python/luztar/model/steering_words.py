"""The steering structure's own parameters, its effects, and their words where those of a friction rig do not fit.

A steering model runs freely: the handwheel's angle goes in and the road wheel's angle comes out. Friction acts on the
road wheel, spring and freeplay stand at the handwheel.
"""

from __future__ import annotations

from collections.abc import Mapping

# key, symbol, meaning, lower bound.
OWN = (
    ("inertia_kg_m2", "I", "moment of inertia of the road wheels about the king-pins", 0.0),
    ("ratio", "p", "angle of the handwheel per angle of the road wheel", 0.0),
    ("stiffness_nm_per_rad", "K", "stiffness of the column, at the handwheel", 0.0),
    ("aligning_nm_per_rad", "c", "aligning torque per angle of the road wheel", 0.0),
)
# What may be written in a model file in place of the whole key.
SHORT_KEYS: Mapping[str, str] = {
    "inertia": "inertia_kg_m2",
    "ratio": "ratio",
    "stiffness": "stiffness_nm_per_rad",
    "aligning": "aligning_nm_per_rad",
}
# A free run holds a body at rest exactly: Coulomb friction needs no travel to its full size.
RIGID = ("coulomb.breakaway_rad",)
# key, or effect and key: what differs from the parameter of a rig.
MEANINGS: Mapping[str, Mapping[str, str]] = {
    "level_nm": {"meaning": "dry friction at the king-pins while moving"},
    "gap_rad": {"meaning": "full width of the gap, at the handwheel"},
    "coefficient_nm_per_rad3": {"meaning": "torque per wind-up cubed, at the handwheel"},
    "delay.time_s": {"meaning": "how late the road wheel's channel is"},
    "end_stop.limit_rad": {"meaning": "angle of the road wheel where the stop is met"},
    "end_stop.stiffness_nm_per_rad": {"meaning": "stiffness of the stop, at the road wheel"},
    "dead_zone.half_width_rad": {"meaning": "half width of the dead zone, at the road wheel"},
    "load.coefficient": {"meaning": "friction per torque on the road wheel"},
    "presliding.breakaway_rad": {"meaning": "travel of the road wheel from rest to full friction"},
}
# A model may hold it and is simulated with it; a search does not try it: an angle alone does not tell it from others.
SIMULATED: Mapping[str, object] = {"structures": ("rig", "axis")}
# effect: what differs from the card of a rig. Every effect of a steering model stands here.
WORDS: Mapping[str, Mapping[str, object]] = {
    "offset": {
        "look": "The road wheel's angle is shifted by the same amount everywhere.",
        "cause": "Sensors not zeroed to each other, toe or centre point set off the middle.",
        "check": "Zero both sensors in the straight-ahead position.",
    },
    "coulomb": {
        "look": "After every reversal of the handwheel the road wheel waits, then follows; slow motion goes in stairs.",
        "cause": "Dry king-pins, joints, steering box set too tight.",
        "check": "Grease the king-pins; measure the torque to turn the lifted wheels.",
    },
    "viscous": {
        "look": "The road wheel lags behind the handwheel, the more the faster it turns.",
        "cause": "Steering damper, oil, grease.",
        "check": "Repeat slowly and fast; disconnect the damper.",
    },
    "asymmetric_coulomb": {
        "look": "The road wheel waits longer in one direction than in the other.",
        "cause": "One king-pin or joint that binds on one side.",
        "check": "Measure the torque to turn the lifted wheels, to the left and to the right.",
    },
    "asymmetric_viscous": {
        "look": "The road wheel lags more in one direction than in the other.",
        "cause": "A damper with unequal valves.",
        "check": "Disconnect the damper and repeat.",
    },
    "drag": {
        "look": "The lag grows ever faster with speed.",
        "cause": "Steering damper with orifices, stirred oil.",
        "check": "Compare three even speeds; disconnect the damper.",
    },
    "stribeck": {
        "look": "The road wheel hangs back when it turns slowly and catches up when it turns faster.",
        "cause": "Boundary lubrication of king-pins and joints.",
        "check": "Grease; repeat with one very slow and one fast turn.",
    },
    "stiction": {
        "look": "The road wheel sticks and jumps: after every stop it breaks away with a step.",
        "cause": "King-pins or seals that settle at rest.",
        "check": "Turn very slowly and look for steps; grease the king-pins.",
    },
    "presliding": {
        "look": "The road wheel gives way a little before it slides and swings on its contact where it should stand.",
        "cause": "Rubber bushes and seals of the king-pins, tyres standing on the ground.",
        "check": "Push the standing road wheel to and fro below its break-away and watch the angle.",
        "becomes": None,
    },
    "dwell": {
        "look": "After a longer rest the road wheel breaks away later and with a larger jump.",
        "cause": "Grease squeezed out of the king-pins, seals that settle.",
        "check": "Start after rests of different length.",
    },
    "end_stop": {
        "equation": "k luz(phi, limit) at the road wheel",
        "look": "Beyond one angle on either side the road wheel no longer follows.",
        "cause": "Steering lock, a stop screw set too tight.",
        "check": "Turn to the lock on both sides and measure the angles.",
    },
    "dead_zone": {
        "equation": "k luz(phi, half_width) at the road wheel",
        "look": "Towards both ends the road wheel follows less than in the middle.",
        "cause": "Hoses or cables that become tight, a centring spring with play.",
        "check": "Route them freely; measure the torque to hold the lifted wheels over the angle.",
        "becomes": None,
        **SIMULATED,
    },
    "once_per_rev": {
        "equation": "a sin(p phi + phase) at the pinion",
        "look": "The road wheel runs ahead and behind once per turn of the pinion.",
        "cause": "A pinion or worm out of centre, an unbalanced mass on the lower column.",
        "check": "Measure the torque over two turns of the pinion with the wheels lifted.",
    },
    "twice_per_rev": {
        "equation": "a sin(2 p phi + phase) at the pinion",
        "look": "The road wheel runs ahead and behind twice per turn of the pinion.",
        "cause": "Universal joints of the column at an angle.",
        "check": "Check the angles and the phase of the universal joints.",
        **SIMULATED,
    },
    "cogging": {
        "equation": "a sin(n p phi + phase) at the pinion, n >= 3",
        "look": "Even waves of the road wheel over the angle.",
        "cause": "Teeth of the gear, magnets of an assisting motor.",
        "check": "Count the waves per turn of the pinion: teeth or pole pairs have that number.",
        **SIMULATED,
    },
    "position_coulomb": {
        "look": "The road wheel hangs back more on one side than on the other.",
        "cause": "A king-pin or rack that binds towards one end.",
        "check": "Measure the torque to turn the lifted wheels over the angle.",
        **SIMULATED,
    },
    "tight_spot": {
        "look": "The road wheel sticks at one angle.",
        "cause": "A worn middle of the gear set too tight, a dent.",
        "check": "Turn slowly through the angle and feel; set the gear's play.",
        **SIMULATED,
    },
    "load": {
        "equation": "+ c |load| on the level, the load being the torque on the road wheel",
        "look": "The road wheel hangs back more under side force.",
        "cause": "King-pins and joints under load.",
        "check": "Repeat with the wheels lifted and on the ground.",
        **SIMULATED,
    },
    "freeplay": {
        "equation": "K luz(psi - p phi, gap/2)",
        "look": "After every reversal the road wheel stands while the handwheel crosses the gap; around the middle it "
        "follows loosely.",
        "cause": "Backlash of the steering gear, worn joints, loose coupling of the column.",
        "check": "Rock the handwheel about the middle with the road wheels held; adjust the gear, check joints.",
        "needs": None,
        "becomes": None,
    },
    "hardening": {
        "equation": "K3 luz(psi - p phi, gap/2)^3",
        "look": "The road wheel follows more stiffly where the column is wound up far.",
        "cause": "Rubber coupling of the column, torsion bar that reaches its stop.",
        "check": "Hold the road wheels and measure handwheel torque over angle.",
    },
    "delay": {
        "equation": "phi(t) = model(t - tau)",
        "look": "The road wheel is late by the same time everywhere.",
        "cause": "A filter in one channel only, bus latency, unsynchronised clocks.",
        "check": "Record both channels on one clock with the same filter.",
        "becomes": None,
    },
}
