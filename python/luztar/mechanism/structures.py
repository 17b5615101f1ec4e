"""The structures by name, from one mass to the whole steering mechanism, with defaults that have a source.

Defaults: WZ is the seed paper (Wieckowski, Zardecki), EPS the public textbook set of an electric power steering,
CM the dynamic-ratio steering of CarMaker's public parameter files; "rule" is a rule of thumb of the trade; "own" is our
choice, with its reason.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..errors import ParameterError
from .mechanism import Mechanism
from .parts import Assistance, Body, Damper, Driven, Friction, Load, Sensor, Spring


def single_mass(
    *,
    inertia: float = 1.0,
    stiffness: float = 0.0,
    gap: float = 0.0,
    viscous: float = 0.0,
    kinetic: float = 0.0,
    static: float | None = None,
    on_belt: bool = False,
    unit: str = "m",
) -> Mechanism:
    """Return one mass on a spring under a force: Den Hartog's oscillator, the belt, the freeplay oscillator.

    Parameters
    ----------
    inertia : float, > 0
        kg or kg m2.
    stiffness, gap : float, >= 0
        Spring to the ground and its freeplay (full width).
    viscous, kinetic : float, >= 0
        Viscous and dry friction on the ground or the belt.
    static : float, optional
        Static friction, as ``kinetic`` where it is not given.
    on_belt : bool
        Whether the mass rests on a belt: a driven node named ``belt``.
    unit : {"m", "rad"}

    Returns
    -------
    Mechanism
        Body ``mass``, load ``force``, elements ``spring``, ``damper``, ``friction``; those that are 0 are left out.
    """
    floor = "belt" if on_belt else "ground"
    elements = [
        Spring("spring", "mass", stiffness=stiffness, gap=gap, unit=unit) if stiffness else None,
        Damper("damper", "mass", floor, viscous=viscous, unit=unit) if viscous else None,
        Friction("friction", "mass", floor, kinetic=kinetic, static=static, unit=unit) if kinetic or static else None,
    ]
    return Mechanism(
        title="single mass",
        bodies=(Body("mass", inertia, unit),),
        driven=(Driven("belt", unit),) if on_belt else (),
        loads=(Load("force", "mass"),),
        elements=tuple(e for e in elements if e is not None),
    )


# Key of a steering model: element and field.
_OF_STEERING = {
    "steering.stiffness_nm_per_rad": ("column", "stiffness"),
    "freeplay.gap_rad": ("column", "gap"),
    "hardening.coefficient_nm_per_rad3": ("column", "hardening"),
    "steering.aligning_nm_per_rad": ("aligning", "stiffness"),
    "viscous.coefficient_nm_s_per_rad": ("damper", "viscous"),
    "drag.coefficient_nm_s2_per_rad2": ("damper", "drag"),
    "coulomb.level_nm": ("king_pin", "kinetic"),
    "asymmetric_coulomb.difference_nm": ("king_pin", "difference"),
    "stribeck.extra_nm": ("king_pin", "stribeck"),
    "stribeck.speed_rad_s": ("king_pin", "stribeck_speed"),
}


def steering_one_mass(parameters: Mapping[str, float]) -> Mechanism:
    """Return the one-mass steering model (WZ, equation 5) as a mechanism.

    Parameters
    ----------
    parameters : mapping of str to float
        Keys of :func:`luztar.dynamics.simulate`, one value each.

    Returns
    -------
    Mechanism
        Driven node ``handwheel``, body ``roadwheel``, load ``load``, elements ``column``, ``aligning``, ``damper``,
        ``king_pin``.

    Raises
    ------
    ParameterError
        A key that is unknown, or has no place in a mechanism (one-sided viscous friction).
    """
    given: dict[str, dict[str, float]] = {}
    rest = dict(parameters)
    try:
        inertia, ratio = rest.pop("steering.inertia_kg_m2"), rest.pop("steering.ratio")
    except KeyError as key:
        raise ParameterError(f"{key.args[0]} is missing", "parameters", "Give inertia and ratio.") from None
    stiction = rest.pop("stiction.extra_nm", 0.0)
    for key, value in rest.items():
        if key not in _OF_STEERING:
            known = ", ".join(_OF_STEERING)
            raise ParameterError(f"'{key}' has no place in a mechanism", "parameters", f"Known are: {known}.")
        element, field = _OF_STEERING[key]
        given.setdefault(element, {})[field] = float(value)
    pin = given.get("king_pin", {})
    static = pin.get("kinetic", 0.0) + pin.get("stribeck", 0.0) + stiction
    return Mechanism(
        title="steering of one mass",
        bodies=(Body("roadwheel", inertia),),
        driven=(Driven("handwheel"),),
        loads=(Load("load", "roadwheel"),),
        elements=(
            Spring("column", "handwheel", "roadwheel", ratio_b=ratio, **given.get("column", {})),
            Spring("aligning", "roadwheel", **given.get("aligning", {})),
            Damper("damper", "roadwheel", **given.get("damper", {})),
            Friction("king_pin", "roadwheel", static=static, **pin),
        ),
    )


def steering_torque_driven(
    *,
    handwheel_inertia_kg_m2: float = 0.04,
    column_friction_nm: float = 0.2,
    column_viscous_nm_s_per_rad: float = 0.072,
    stiffness_nm_per_rad: float = 60.0,
    gap_rad: float = 0.1,
    ratio: float = 16.0,
    roadwheel_inertia_kg_m2: float = 3.0,
    roadwheel_viscous_nm_s_per_rad: float = 40.0,
    king_pin_friction_nm: float = 8.1,
    king_pin_static_nm: float | None = None,
    aligning_nm_per_rad: float = 0.0,
) -> Mechanism:
    """Return a steering whose handwheel is turned by a torque: two masses, column stiffness, freeplay of the gear.

    Parameters
    ----------
    handwheel_inertia_kg_m2 : float
        0.04 (EPS; rule 0.03 to 0.05).
    column_friction_nm, column_viscous_nm_s_per_rad : float
        0.2 (rule 0.1 to 0.5) and 0.072 (EPS), on the handwheel.
    stiffness_nm_per_rad, gap_rad, ratio : float
        At the handwheel: 60 and 16 (own: with 3 kg m2 an eigenfrequency of 11.4 Hz), full freeplay 0.1 (WZ: half width
        0.05).
    roadwheel_inertia_kg_m2, roadwheel_viscous_nm_s_per_rad : float
        Both steered wheels at the king-pins: 3 and 40 (own).
    king_pin_friction_nm, king_pin_static_nm : float
        8.1 (WZ), static as kinetic where it is not given.
    aligning_nm_per_rad : float
        Spring to the ground at the road wheels.

    Returns
    -------
    Mechanism
        Bodies ``handwheel``, ``roadwheel``; loads ``hand`` and ``tyre``.
    """
    return Mechanism(
        title="steering driven by torque",
        bodies=(Body("handwheel", handwheel_inertia_kg_m2), Body("roadwheel", roadwheel_inertia_kg_m2)),
        loads=(Load("hand", "handwheel"), Load("tyre", "roadwheel")),
        elements=(
            Spring("column", "handwheel", "roadwheel", stiffness=stiffness_nm_per_rad, gap=gap_rad, ratio_b=ratio),
            Damper("column_damper", "handwheel", viscous=column_viscous_nm_s_per_rad),
            Friction("column_friction", "handwheel", kinetic=column_friction_nm),
            Spring("aligning", "roadwheel", stiffness=aligning_nm_per_rad),
            Damper("wheel_damper", "roadwheel", viscous=roadwheel_viscous_nm_s_per_rad),
            Friction("king_pin", "roadwheel", kinetic=king_pin_friction_nm, static=king_pin_static_nm),
        ),
    )


@dataclass(frozen=True)
class RearAxle:
    """A steered rear axle (4WS), turned by a shaft from the rack. All defaults own, in proportion to the front.

    Attributes
    ----------
    ratio : float
        Rear angle per front angle.
    inertia_kg_m2, viscous_nm_s_per_rad, friction_nm : float
        Both rear wheels at their king-pins.
    static_nm : float, optional
    stiffness_nm_per_rad : float
        Of the shaft and its gear, at the rear wheels.
    gap_rad : float
        Full freeplay, at the rear wheels.
    """

    ratio: float = 0.15
    inertia_kg_m2: float = 3.0
    viscous_nm_s_per_rad: float = 40.0
    friction_nm: float = 8.1
    static_nm: float | None = None
    stiffness_nm_per_rad: float = 2.0e4
    gap_rad: float = 0.002


def power_assistance(force_n: float = 600.0, from_rad: float = 0.01, to_rad: float = 0.05) -> Assistance:
    """Return a boost curve: none up to a twist of the column, then a line to its limit, constant beyond.

    Parameters
    ----------
    force_n : float
        Limit, N at the rack; 600 (own: reached at a hand torque of 5.75 Nm with 115 Nm/rad). A curve of three times the
        slope makes the default mechanism hunt through its freeplay, as a real one without a damped controller would.
    from_rad, to_rad : float
        Twist of the column at which assistance begins and reaches its limit.
    """
    return Assistance("assistance", "column", "rack", twist=(from_rad, to_rad), torque=(0.0, force_n))


def steering_mechanism(
    *,
    handwheel: str = "angle",
    handwheel_inertia_kg_m2: float = 0.04,
    column_stiffness_nm_per_rad: float = 115.0,
    column_friction_nm: float = 0.2,
    column_viscous_nm_s_per_rad: float = 0.072,
    pinion_inertia_kg_m2: float = 0.001,
    gear_stiffness_nm_per_rad: float = 2000.0,
    gear_gap_rad: float = 0.1,
    rack_ratio_rad_per_m: float = 100.0,
    rack_mass_kg: float = 10.0,
    rack_viscous_n_s_per_m: float = 50.0,
    rack_friction_n: float = 100.0,
    rack_static_n: float | None = None,
    steering_arm_m: float = 0.16,
    tie_rod_stiffness_n_per_m: float = 6.7e5,
    tie_rod_gap_m: float = 0.0,
    wheel_inertia_kg_m2: float = 1.5,
    wheel_viscous_nm_s_per_rad: float = 20.0,
    king_pin_friction_nm: float = 4.05,
    king_pin_static_nm: float | None = None,
    aligning_nm_per_rad: float = 0.0,
    assistance: Assistance | None = None,
    rear_axle: RearAxle | None = None,
) -> Mechanism:
    """Return the seed paper's mechanism (figure 3): handwheel, column, gear, rack, tie rods, two steered wheels.

    Parameters
    ----------
    handwheel : {"angle", "torque"}
        Whether its angle is given (node ``handwheel``) or a torque on it (load ``hand``).
    handwheel_inertia_kg_m2 : float
        0.04 (EPS), with a torque only.
    column_stiffness_nm_per_rad, column_friction_nm, column_viscous_nm_s_per_rad : float
        Torsion bar and shaft: 115 (rule 1.5 to 2.5 Nm per degree); friction and damping on the pinion's shaft:
        0.2 (rule), 0.072 (EPS).
    pinion_inertia_kg_m2, gear_stiffness_nm_per_rad, gear_gap_rad : float
        0.001 (CM), 2000 (own), full freeplay 0.1 at the pinion (WZ: half width 0.05 at the handwheel).
    rack_ratio_rad_per_m, rack_mass_kg, rack_viscous_n_s_per_m : float
        100, 10, 50 (CM).
    rack_friction_n, rack_static_n : float
        100 (rule 100 to 300).
    steering_arm_m : float
        0.16: with the rack's ratio an overall ratio of 16.
    tie_rod_stiffness_n_per_m, tie_rod_gap_m : float
        6.7e5 each (own: the whole mechanism is then as stiff as the one-mass model, 60 Nm/rad at the handwheel).
    wheel_inertia_kg_m2, wheel_viscous_nm_s_per_rad : float
        1.5, 20 each (own: together the one-mass model's).
    king_pin_friction_nm, king_pin_static_nm : float
        4.05 each (WZ: 8.1 together).
    aligning_nm_per_rad : float
        Spring to the ground at each steered wheel.
    assistance : Assistance, optional
        As :func:`power_assistance`.
    rear_axle : RearAxle, optional

    Returns
    -------
    Mechanism
        Bodies ``pinion``, ``rack``, ``left_wheel``, ``right_wheel`` (and ``handwheel``, ``rear_wheels``); loads
        ``tyre_left``, ``tyre_right`` (and ``hand``, ``tyre_rear``); sensor ``hand_torque``.

    Raises
    ------
    ParameterError
        Names the part.
    """
    if handwheel not in ("angle", "torque"):
        raise ParameterError(f"handwheel is {handwheel!r}", "handwheel", "Give angle or torque.")
    by_torque = handwheel == "torque"
    bodies = [
        Body("pinion", pinion_inertia_kg_m2),
        Body("rack", rack_mass_kg, "m"),
        Body("left_wheel", wheel_inertia_kg_m2),
        Body("right_wheel", wheel_inertia_kg_m2),
    ]
    loads = [Load("tyre_left", "left_wheel"), Load("tyre_right", "right_wheel")]
    if by_torque:
        bodies.insert(0, Body("handwheel", handwheel_inertia_kg_m2))
        loads.insert(0, Load("hand", "handwheel"))
    elements = [
        Spring("column", "handwheel", "pinion", stiffness=column_stiffness_nm_per_rad),
        Damper("column_damper", "pinion", viscous=column_viscous_nm_s_per_rad),
        Friction("column_friction", "pinion", kinetic=column_friction_nm),
        Spring(
            "gear",
            "pinion",
            "rack",
            stiffness=gear_stiffness_nm_per_rad,
            gap=gear_gap_rad,
            ratio_b=rack_ratio_rad_per_m,
        ),
        Damper("rack_damper", "rack", viscous=rack_viscous_n_s_per_m, unit="m"),
        Friction("rack_friction", "rack", kinetic=rack_friction_n, static=rack_static_n, unit="m"),
    ]
    for side in ("left", "right"):
        wheel = f"{side}_wheel"
        rod = {"stiffness": tie_rod_stiffness_n_per_m, "gap": tie_rod_gap_m, "ratio_b": steering_arm_m, "unit": "m"}
        elements += [
            Spring(f"{side}_tie_rod", "rack", wheel, **rod),
            Damper(f"{side}_damper", wheel, viscous=wheel_viscous_nm_s_per_rad),
            Friction(f"{side}_king_pin", wheel, kinetic=king_pin_friction_nm, static=king_pin_static_nm),
        ]
        if aligning_nm_per_rad:
            elements.append(Spring(f"{side}_aligning", wheel, stiffness=aligning_nm_per_rad))
    if assistance is not None:
        elements.append(assistance)
    if rear_axle is not None:
        bodies.append(Body("rear_wheels", rear_axle.inertia_kg_m2))
        loads.append(Load("tyre_rear", "rear_wheels"))
        elements += [
            Spring(
                "rear_shaft",
                "rack",
                "rear_wheels",
                stiffness=rear_axle.stiffness_nm_per_rad,
                gap=rear_axle.gap_rad,
                ratio_a=rear_axle.ratio / steering_arm_m,
            ),
            Damper("rear_damper", "rear_wheels", viscous=rear_axle.viscous_nm_s_per_rad),
            Friction("rear_king_pins", "rear_wheels", kinetic=rear_axle.friction_nm, static=rear_axle.static_nm),
        ]
    return Mechanism(
        title="steering mechanism",
        bodies=tuple(bodies),
        driven=() if by_torque else (Driven("handwheel"),),
        loads=tuple(loads),
        elements=tuple(elements),
        sensors=(Sensor("hand_torque", "column", "torque"),),
    )
