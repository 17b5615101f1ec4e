"""What a batch keeps is what single runs have; drives of its own for every lane; an interrupt keeps what is done."""

import _thread
import hashlib
import subprocess
import sys
import threading

import numpy as np
import pytest

from luztar.dynamics import Summary, simulate, summarise, trace
from luztar.errors import Interrupted, ParameterError
from test_dynamics_bits import lanes, psi

LANES = 70
RATE = {"sample_rate_hz": 500, "substeps": 2}
EVERY = ("last", "peak", "rms", "at_rest", "events", "energy", "envelope", "samples", "trace")
OPTIONS = {**RATE, "keep": EVERY, "window_s": 0.3, "times_s": [0.0, 0.5, 1.5, 2.998]}
SCRIPT = """
from test_batches import digest
print(digest())
"""


def one(lane: int, given: dict[str, np.ndarray]) -> dict[str, float]:
    return {k: float(v[lane]) for k, v in given.items()}


def own_drives() -> tuple[np.ndarray, np.ndarray]:
    """A hand and a load of its own for every lane."""
    t = np.arange(1500) / 500
    chance = np.random.default_rng(3)
    f = chance.uniform(0.2, 1.5, (LANES, 1))
    return np.sin(2 * np.pi * f * t), 5.0 * np.sin(2 * np.pi * (f + 0.3) * t + 1.0)


def digest(index: np.ndarray | None = None, **options: object) -> str:
    """A hash of all that a batch keeps, of some lanes, in the order of their numbers."""
    index = np.arange(LANES) if index is None else index
    hand, load = own_drives()
    given = {k: v[index] for k, v in lanes(LANES).items()}
    made = summarise(given, hand[index], load_nm=load[index], **OPTIONS, **options)
    out = hashlib.sha256()
    for name in sorted(made):
        out.update(name.encode() + made[name][np.argsort(index)].tobytes())
    return out.hexdigest()


FURTHER = {
    "end_stop.stiffness_nm_per_rad": 500.0,
    "end_stop.limit_rad": 0.04,
    "dwell.extra_nm": 2.0,
    "dwell.time_s": 0.2,
    "once_per_rev.amplitude_nm": 1.0,
}


@pytest.mark.parametrize(
    ("method", "further"),
    [
        ("split", {}),
        ("split", FURTHER),
        ("split", {**FURTHER, "presliding.breakaway_rad": 0.02}),
        ("moreau_jean", FURTHER),
    ],
)
def test_events_and_energies_of_a_lane_are_those_of_its_trace(method, further):
    hand, load = own_drives()
    # Every second lane has what is further given: neighbours take another way through the step.
    given = lanes(LANES) | {k: np.where(np.arange(LANES) % 2, v, 0.0) for k, v in further.items()}
    if "dwell.time_s" in further:
        given["dwell.time_s"] = np.full(LANES, further["dwell.time_s"])
    if "presliding.breakaway_rad" in further:
        # An elastic contact is never at rest: nothing that rest brings about goes with it.
        rigid = given["presliding.breakaway_rad"] == 0.0
        given |= {k: np.where(rigid, given[k], 0.0) for k in ("stiction.extra_nm", "dwell.extra_nm")}
    many = summarise(given, hand, load_nm=load, method=method, **OPTIONS)
    for lane in range(0, LANES, 3):
        alone = trace(one(lane, given), hand[lane], load_nm=load[lane], method=method, **RATE)
        for kind in ("stick", "slip", "reversal", "contact", "release"):
            assert many[f"{kind}_count"][lane] == sum(e.kind == kind for e in alone.events), (lane, kind)
        for name, value in alone.energy_j.items():
            assert many[f"energy_{name}_j"][lane] == value, (lane, name)
        assert np.array_equal(many["roadwheel_rad"][lane], alone.roadwheel_rad)
        assert np.array_equal(many["speed_rad_s"][lane], alone.speed_rad_s)
    # Without a slip, a contact and a reversal the test says nothing.
    assert all(many[f"{kind}_count"].sum() > LANES for kind in ("stick", "slip", "contact", "release"))
    assert many["reversal_count"].sum() > 0


def test_envelope_and_chosen_samples_are_those_of_the_trajectory():
    given = lanes(LANES)
    many = summarise(given, psi(), **OPTIONS)
    run = simulate(given, psi(), **RATE).roadwheel_rad
    assert many["least_rad"].shape == many["greatest_rad"].shape == (LANES, 10)
    for k in range(10):
        part = run[:, 150 * k : 150 * (k + 1)]
        assert np.array_equal(many["least_rad"][:, k], part.min(axis=1))
        assert np.array_equal(many["greatest_rad"][:, k], part.max(axis=1))
    assert np.array_equal(many["sample_rad"], run[:, [0, 250, 750, 1499]])
    assert np.array_equal(many["peak_rad"], np.abs(run).max(axis=1))


def test_what_is_not_asked_for_is_not_there():
    assert set(summarise(lanes(3), psi(), **RATE, keep="rms")) == {"rms_rad"}
    assert set(summarise(lanes(3), psi(), **RATE, keep=["last", "events"])) == {
        *("last_rad", "last_speed_rad_s"),
        *(f"{kind}_count" for kind in ("stick", "slip", "reversal", "contact", "release")),
    }


def test_a_drive_repeated_for_every_lane_gives_the_bits_of_the_shared_one():
    given = lanes(LANES)
    load = 3.0 * psi()
    shared = simulate(given, psi(), load_nm=load, **RATE)
    for hand, weight in ((np.tile(psi(), (LANES, 1)), load), (psi(), np.tile(load, (LANES, 1)))):
        own = simulate(given, hand, load_nm=weight, **RATE)
        assert np.array_equal(own.roadwheel_rad, shared.roadwheel_rad)
        assert np.array_equal(own.speed_rad_s, shared.speed_rad_s)


def test_a_lane_with_its_own_drive_is_the_run_alone():
    given = lanes(LANES)
    hand, load = own_drives()
    many = simulate(given, hand, load_nm=load, **RATE)
    for lane in (0, 31, 32, 69):
        alone = simulate(one(lane, given), hand[lane], load_nm=load[lane], **RATE)
        assert np.array_equal(many.roadwheel_rad[lane], alone.roadwheel_rad)


def test_one_mechanism_may_have_many_drives():
    hand, _ = own_drives()
    alone = one(0, lanes(1))
    many = simulate(alone, hand, **RATE)
    assert many.roadwheel_rad.shape == hand.shape
    assert np.array_equal(many.roadwheel_rad[5], simulate(alone, hand[5], **RATE).roadwheel_rad)


def test_a_function_gives_drives_a_few_lanes_at_a_time(monkeypatch):
    for name in ("LEAST_LANES", "MOST_LANES"):
        monkeypatch.setattr(f"luztar.dynamics.batch_inputs.{name}", 32)
    hand, load = own_drives()
    asked = []

    def drive(index):
        asked.append(index.size)
        return hand[index]

    made = summarise(lanes(LANES), drive, load_nm=lambda index: load[index], **OPTIONS)
    whole = summarise(lanes(LANES), hand, load_nm=load, **OPTIONS)
    assert max(asked) == 32
    assert all(np.array_equal(made[name], whole[name]) for name in whole)
    with pytest.raises(ParameterError, match=r"handwheel_rad.*shape \(31, 1500\)"):
        summarise(lanes(LANES), lambda index: hand[index][: max(1, index.size - 1)], **RATE)


def test_the_same_bits_for_every_instruction_set_chunk_and_order_of_shards(monkeypatch):
    order = np.random.default_rng(1).permutation(LANES)
    found = {digest(), digest(order), *(digest(width=w) for w in ("baseline", "avx2", "avx512"))}
    for name in ("LEAST_LANES", "MOST_LANES"):
        monkeypatch.setattr(f"luztar.dynamics.batch_inputs.{name}", 13)
    assert found == {digest()}


def test_the_same_bits_for_every_number_of_threads(monkeypatch, request):
    found = set()
    for threads in ("1", "2", "4"):
        monkeypatch.setenv("RAYON_NUM_THREADS", threads)
        folder = request.path.parent
        run = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True, cwd=folder)
        found.add(run.stdout.strip())
    assert found == {digest()}


def test_an_interrupt_keeps_what_is_done_and_the_rest_is_gone_on_with(monkeypatch, tmp_path):
    for name in ("LEAST_LANES", "MOST_LANES"):
        monkeypatch.setattr(f"luztar.dynamics.batch_inputs.{name}", 16)
    given, options = lanes(LANES), OPTIONS

    def stop(done, of):
        if done >= 32:
            _thread.interrupt_main()

    with pytest.raises(Interrupted, match=f"of {LANES} lanes are done") as caught:
        summarise(given, psi(), progress=stop, **options)
    partial = caught.value.partial
    assert isinstance(caught.value, KeyboardInterrupt)
    assert 32 <= partial.done.size < LANES and not partial.complete
    assert np.array_equal(caught.value.done, partial.done)
    whole = summarise(given, psi(), **options)
    assert all(np.array_equal(partial[name], whole[name][partial.done]) for name in whole)

    partial.save(tmp_path / "partial.npz")
    told = []
    again = Summary.load(tmp_path / "partial.npz")
    made = summarise(given, psi(), resume=again, progress=lambda done, of: told.append(done), **options)
    assert made.complete and told[0] > partial.done.size
    assert all(np.array_equal(made[name], whole[name]) for name in whole)
    with pytest.raises(ParameterError, match="not begun like this"):
        summarise(given, 2.0 * psi(), resume=again, **options)


def test_an_interrupt_is_heard_in_the_midst_of_a_lane():
    # 1.5e8 steps of every lane of one block take half a minute at least: none is finished when the interrupt comes.
    threading.Timer(0.3, _thread.interrupt_main).start()
    with pytest.raises(Interrupted) as caught:
        summarise(lanes(4), psi(), sample_rate_hz=500, substeps=100_000)
    assert caught.value.done.size == 0 and caught.value.lanes == 4
    assert caught.value.partial["peak_rad"].shape == (0,)


def test_steps_too_fine_to_be_refined_beforehand_have_the_same_bits():
    given = one(0, {k: v for k, v in lanes(1).items() if not k.startswith(("stribeck", "drag"))})
    # 3 intervals of 800 000 steps: beyond what is refined beforehand.
    fine = simulate(given, psi()[300:304], sample_rate_hz=500, substeps=800_000)
    alone = trace(given, psi()[300:304], sample_rate_hz=500, substeps=800_000)
    assert np.array_equal(fine.roadwheel_rad, alone.roadwheel_rad) and np.ptp(fine.roadwheel_rad) > 0.0


def test_an_error_of_the_progress_callback_goes_through():
    def fail(done, of):
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        summarise(lanes(3), psi(), progress=fail, **RATE)


@pytest.mark.parametrize(
    ("options", "word"),
    [
        ({"keep": ("peek",)}, "no reducer 'peek'.*last, peak"),
        ({"keep": ("envelope",)}, "needs window_s"),
        ({"keep": ("samples",)}, "needs times_s"),
        ({"window_s": 0.1}, "window_s is for 'envelope'"),
        ({"keep": ("envelope",), "window_s": 1e-4}, "at least one sampling interval"),
        ({"keep": ("samples",), "times_s": [0.0013]}, "no sample at 0.0013 s.*multiples of 0.002 s"),
        ({"keep": ("samples",), "times_s": [1.0, 0.5]}, "does not increase"),
        ({"keep": ("samples",), "times_s": [3.0]}, "no sample at 3 s"),
        ({"load_nm": np.zeros((2, 1500))}, "load_nm has 2 values, others 3"),
        ({"load_nm": np.zeros((3, 7))}, "load_nm has 7 samples, handwheel_rad 1500"),
        ({"start_rad": "there"}, "start_rad"),
        ({"resume": {}}, "not begun like this"),
    ],
)
def test_a_wrong_option_is_named(options, word):
    with pytest.raises(ParameterError, match=word):
        summarise(lanes(3), psi(), **{**RATE, **options})


def test_one_wrong_lane_of_many_is_named_before_any_runs(monkeypatch):
    for name in ("LEAST_LANES", "MOST_LANES"):
        monkeypatch.setattr(f"luztar.dynamics.batch_inputs.{name}", 16)
    given = lanes(LANES)
    given["coulomb.level_nm"][41] = -1.0
    told = []
    with pytest.raises(ParameterError, match="coulomb_nm is -1.*lane 41"):
        summarise(given, psi(), progress=lambda *a: told.append(a), **RATE)
    given = lanes(LANES)
    given["steering.inertia_kg_m2"][17] = 1e-4
    with pytest.raises(ParameterError, match="step.*stiffness_nm_per_rad of lane 17"):
        summarise(given, psi(), progress=lambda *a: told.append(a), **RATE)
    hand, _ = own_drives()
    hand[3, 7] = np.nan
    with pytest.raises(ParameterError, match=r"handwheel_rad.*\(3, 7\)"):
        summarise(lanes(LANES), hand, **RATE)
    assert told == []


def test_a_summary_prints_and_travels():
    made = summarise(lanes(20), psi(), **OPTIONS)
    assert str(made).startswith("20 lanes") and "peak_rad" in str(made) and "20 x 10 values" in str(made)
    assert made.to_dict()["values"]["peak_rad"] == made["peak_rad"].tolist()
