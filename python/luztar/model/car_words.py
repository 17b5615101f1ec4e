"""The car structure's own parameters, its effects, and their words where those of a friction rig do not fit.

The handwheel's angle and the speed go in, the motion of the car comes out. Keys are those of ``luztar.vehicle.Car``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

# section: its title, then key, symbol, meaning, lower bound of every parameter.
OWN: Mapping[str, tuple[str, tuple[tuple[str, str, str, float], ...]]] = {
    "body": (
        "body of the car",
        (
            ("mass_kg", "m", "mass of the car", 0.0),
            ("yaw_inertia_kg_m2", "Iz", "moment of inertia about the vertical axis", 0.0),
            ("front_axle_m", "a", "front axle before the centre of mass", 0.0),
            ("rear_axle_m", "b", "rear axle behind the centre of mass", 0.0),
            ("sprung_mass_kg", "ms", "mass that rolls", 0.0),
            ("roll_arm_m", "h", "height of the rolling mass above the roll axis", -math.inf),
            ("roll_inertia_kg_m2", "Ix", "moment of inertia about the roll axis", 0.0),
        ),
    ),
    "front": (
        "front axle",
        (
            ("cornering_n_per_rad", "Cf", "cornering stiffness, both tyres together", 0.0),
            ("pneumatic_trail_m", "tp", "pneumatic trail at no slip", -math.inf),
            ("caster_trail_m", "tc", "caster trail", -math.inf),
            ("track_m", "wf", "track", 0.0),
            ("roll_stiffness_nm_per_rad", "Kf", "roll stiffness", 0.0),
            ("roll_damping_nm_s_per_rad", "Df", "roll damping", 0.0),
            ("roll_centre_m", "hf", "height of the roll centre", -math.inf),
            ("relaxation_m", "sf", "relaxation length", 0.0),
            ("roll_steer", "ef", "steer of the wheels per roll angle", -math.inf),
            ("load_ratio", "zf", "static load over the load of the largest cornering stiffness", 0.0),
        ),
    ),
    "rear": (
        "rear axle",
        (
            ("cornering_n_per_rad", "Cr", "cornering stiffness, both tyres together", 0.0),
            ("track_m", "wr", "track", 0.0),
            ("roll_stiffness_nm_per_rad", "Kr", "roll stiffness", 0.0),
            ("roll_damping_nm_s_per_rad", "Dr", "roll damping", 0.0),
            ("roll_centre_m", "hr", "height of the roll centre", -math.inf),
            ("relaxation_m", "sr", "relaxation length", 0.0),
            ("roll_steer", "er", "steer of the wheels per roll angle", -math.inf),
            ("load_ratio", "zr", "static load over the load of the largest cornering stiffness", 0.0),
        ),
    ),
    "steering": (
        "steering",
        (
            ("inertia_kg_m2", "I", "moment of inertia of the front wheels about the king-pins", 0.0),
            ("ratio", "p", "angle of the handwheel per angle of the road wheel", 0.0),
            ("stiffness_nm_per_rad", "K", "stiffness of the column, at the handwheel", 0.0),
            ("aligning_nm_per_rad", "c", "centring torque per angle of the road wheel, besides that of the tyres", 0.0),
        ),
    ),
}
# Without these given there is no scale of force, no geometry, or no steering.
GIVEN = ("body.mass_kg", "body.front_axle_m", "body.rear_axle_m", "steering.ratio")
GIVEN_OR_STARTED = ("steering.inertia_kg_m2", "steering.stiffness_nm_per_rad")
# Estimated where they are not given.
ESTIMATED = (
    "body.yaw_inertia_kg_m2",
    "front.cornering_n_per_rad",
    "rear.cornering_n_per_rad",
    "viscous.coefficient_nm_s_per_rad",
)
# With all of them, known or started, the body rolls.
ROLL = (
    "body.sprung_mass_kg",
    "body.roll_arm_m",
    "body.roll_inertia_kg_m2",
    "front.track_m",
    "front.roll_stiffness_nm_per_rad",
    "front.roll_damping_nm_s_per_rad",
    "rear.track_m",
    "rear.roll_stiffness_nm_per_rad",
    "rear.roll_damping_nm_s_per_rad",
)
MEANINGS: Mapping[str, Mapping[str, str]] = {
    "level_nm": {"meaning": "dry friction at the king-pins while moving"},
    "gap_rad": {"meaning": "full width of the gap, at the handwheel"},
    "time_s": {"meaning": "how late every channel out is"},
}
# Every effect of a car model that the catalogue has: what differs from the card of a rig.
WORDS: Mapping[str, Mapping[str, object]] = {
    "offset": {
        "equation": "handwheel = recorded + c",
        "look": "The car turns with the handwheel in its middle.",
        "cause": "Handwheel sensor not zeroed, toe or thrust angle, cambered road.",
        "check": "Drive straight ahead in both directions and zero the handwheel sensor.",
    },
    "coulomb": {
        "look": "Around straight ahead and after every reversal the car waits for the handwheel; in the middle of a "
        "fast turn nothing is missing.",
        "cause": "Dry king-pins, ball joints or steering gear set too tight.",
        "check": "On-centre weave at 0.2 Hz; measure the torque to turn the lifted wheels.",
    },
    "viscous": {
        "look": "The car lags behind the handwheel, the more the faster it turns.",
        "cause": "Steering damper, oil, grease.",
        "check": "Repeat slowly and fast; disconnect the damper.",
    },
    "stribeck": {
        "look": "The road wheels hang back when they turn slowly and catch up when they turn faster.",
        "cause": "Boundary lubrication of king-pins and joints.",
        "check": "Grease; repeat an on-centre weave at three frequencies.",
    },
    "stiction": {
        "look": "Small corrections have no answer, then the car steps aside.",
        "cause": "King-pins or seals that settle at rest.",
        "check": "Hold the handwheel still for some seconds, then turn it very slowly.",
    },
    "freeplay": {
        "equation": "K luz(psi - p phi, gap/2)",
        "look": "Around straight ahead the handwheel moves and the car does not; beyond, the answer lacks the gap.",
        "cause": "Backlash of the steering gear, worn joints, loose coupling of the column.",
        "check": "Rock the handwheel about the middle with the engine running; adjust the gear, check joints.",
        "needs": None,
        "becomes": None,
    },
    "delay": {
        "equation": "y(t) = model(t - tau)",
        "look": "Every channel is late by the same time.",
        "cause": "A filter of the measuring system, bus latency, unsynchronised clocks.",
        "check": "Record all channels on one clock with the same filter.",
        "becomes": None,
    },
}
# Effects of tyres and axles, which the catalogue of friction does not have; of parameters key, symbol, meaning and
# bounds.
CAR_ONLY: tuple[Mapping[str, object], ...] = (
    {
        "name": "tyre_saturation",
        "title": "saturation of the tyres",
        "kind": "tyre",
        "equation": "brush model: force 3 mu Fz th (1 - th + th^2/3), th = C |slip| / (3 mu Fz), at most mu Fz",
        "look": "The larger the handwheel angle, the less yaw rate and lateral acceleration it adds.",
        "cause": "Tyres near their limit of adhesion; wet or cold road.",
        "check": "Repeat with half the amplitude: what is left of the error is no saturation.",
        "typical": "0.3 (snow) to 1.1 (dry)",
        "source": "Fiala; Pacejka, Tire and Vehicle Dynamics, brush model",
        "parameters": (("friction", "mu", "coefficient of adhesion, both axles", 0.05, 10.0),),
    },
    {
        "name": "tyre_relaxation",
        "title": "relaxation of the tyres",
        "kind": "tyre",
        "equation": "length s' = u (slip - s), force = -C s",
        "look": "Yaw rate and lateral acceleration are late by a distance, not by a time: less late at speed.",
        "cause": "A tyre builds up lateral force over half a turn to a turn; soft side walls, low pressure.",
        "check": "Repeat at half the speed: the delay doubles.",
        "typical": "0.2 to 0.8 m",
        "source": "Pacejka, Tire and Vehicle Dynamics, relaxation length",
        "parameters": (("length_m", "sigma", "relaxation length, both axles", 0.0, 5.0),),
    },
    {
        "name": "roll_steer",
        "title": "roll steer",
        "kind": "suspension",
        "equation": "wheel angle = steer + e phi, phi the roll angle to the right",
        "look": "The answer to a quick turn differs from that to a slow one: the axle steers once the body has rolled.",
        "cause": "Geometry of the suspension: height of the steering rack, trailing arms, worn bushes.",
        "check": "Measure toe over suspension travel on both axles.",
        "typical": "-0.2 to 0.2 rad/rad",
        "source": "Gillespie, Fundamentals of Vehicle Dynamics, roll steer",
        "parameters": (
            (
                "front_rad_per_rad",
                "ef",
                "added to the steer of the front wheels per roll angle",
                -math.inf,
                math.inf,
            ),
            (
                "rear_rad_per_rad",
                "er",
                "added to the steer of the rear wheels per roll angle",
                -math.inf,
                math.inf,
            ),
        ),
    },
)
