"""The cards' words for a driven axis, where those of a friction rig speak of wheel, robot and torque.

Equations and sources are those of the cards in the core. Sizes of a rig say nothing about an axis, whose friction is
10 N or 1000 N: no typical size is given.
"""

from __future__ import annotations

from collections.abc import Mapping

# effect: what differs from the card of a rig.
WORDS: Mapping[str, Mapping[str, str]] = {
    "offset": {
        "cause": "Force sensor or drive current not zeroed, weight of the carriage on an inclined axis.",
        "check": "Read the force at rest with the drive off and nothing attached.",
    },
    "coulomb": {
        "cause": "Seals, guides, bearings, preload of nut and belt.",
        "check": "Compare the preload of nut and guides with their data sheet if the level is too high.",
    },
    "viscous": {
        "cause": "Grease, oil, eddy currents in the motor.",
        "check": "Warm the axis up; compare slow and fast strokes.",
    },
    "asymmetric_coulomb": {
        "check": "Read the force with the drive off and nothing attached: what remains is offset, the rest is this.",
    },
    "drag": {"check": "Compare three even speeds; change the lubricant."},
    "stribeck": {"look": "More force at low speed than at medium speed; humps at both ends of a stroke."},
    "presliding": {
        "cause": "Elastic seals, belts, bristles in the contact, a soft coupling.",
        "check": "Reverse slowly at several positions; check the couplings between drive, sensor and carriage.",
    },
    "freeplay": {
        "look": "After every reversal the force drops to the level without friction for the width of the gap.",
        "cause": "Backlash of nut, gear or coupling, worn guide.",
        "check": "Move the carriage by hand with the drive held; check the preload of the nut and the couplings.",
    },
    "dead_zone": {"cause": "Cable chain or hose that becomes tight, springs with play."},
    "stiffness": {
        "cause": "A cable chain or hose that pulls, a spring, a weight compensation.",
        "check": "Route cables freely; disconnect springs and weight compensation.",
    },
    "hardening": {
        "cause": "Rubber parts, bellows, cable chain.",
        "check": "Move further than usual: the cube grows fast.",
    },
    "end_stop": {
        "look": "Force shoots up beyond one position on either side.",
        "cause": "End buffer, cable end, bellows fully drawn out.",
        "check": "Keep away from the end; check buffers, bellows and cable chain.",
    },
    "inertia": {
        "look": "Force leads at the start of a stroke and trails at its end; wiggles of speed show in the force.",
        "cause": "Mass of the carriage, inertia of motor and screw seen at the carriage.",
        "check": "Drive more evenly; compare with the mass and inertias of the data sheets.",
    },
    "once_per_rev": {
        "title": "once-per-turn force",
        "look": "A sine over the position with the pitch as its period, the same in both directions.",
        "cause": "Bent screw, screw or pulley out of centre, coupling out of line.",
        "check": "Measure the run-out of screw and pulley; align the coupling.",
    },
    "twice_per_rev": {
        "title": "twice-per-turn force",
        "cause": "A coupling or universal joint out of line, an oval pulley.",
        "check": "Align the coupling; measure the roundness of the pulley.",
    },
    "cogging": {
        "look": "Even waves over the position, the same in both directions.",
        "cause": "Magnets of the motor, teeth of belt or gear, balls of the nut.",
    },
    "position_coulomb": {
        "title": "friction that changes with position",
        "cause": "Guides that are not parallel, a screw that sags or is clamped askew.",
        "check": "Measure how parallel the guides are; loosen and align the nut.",
    },
    "tight_spot": {
        "look": "The loop bulges at one position, outward on both sides.",
        "cause": "A dent, a dirty tooth or guide, a seal that catches.",
        "check": "Move slowly across the position; clean and inspect there.",
    },
    "load": {
        "look": "The loop widens with the load on the carriage.",
        "cause": "Side load on guides and bearings.",
        "check": "Repeat with a known weight on the carriage; let the load act along the axis.",
    },
    "lead": {
        "title": "force ahead of the position",
        "look": "Every reversal of the force comes before that of the position, by the same time.",
        "cause": "A filter or a tracking loop in the position channel only, channels sampled one after the other, a "
        "command recorded in place of the force.",
    },
    "warmup": {"check": "Drive a few strokes before the record."},
    "drift": {
        "cause": "Force sensor or amplifier warming up.",
        "check": "Let the amplifier warm up for 20 minutes; compare the zero before and after.",
    },
}

# Words in the meanings of parameters.
MEANINGS = (("moment of inertia", "moving mass"), ("torque", "force"), ("angle", "position"))


def meaning(text: str) -> str:
    """Return the meaning of a parameter in the words of an axis."""
    for rig, axis in MEANINGS:
        text = text.replace(rig, axis)
    return text
