"""Find what a friction model lacks, on the bundled demo data: the loop and, step by step, what is in it.

python find_missing_effect.py
"""

from __future__ import annotations

from importlib.resources import files

import luztar


def main() -> None:
    """Run the loop, then one look at the model as given."""
    folder = files("luztar") / "demo_data"
    runs = luztar.read(*(str(folder / f"run{number}.csv.gz") for number in (1, 2, 3)))

    study = luztar.study(luztar.Model.rig(), runs)
    print(study)
    print("named:", ", ".join(study.named) or "nothing")

    # The same by hand: fit, look, add, fit again.
    before = luztar.fit(luztar.Model.rig(), runs)
    look = luztar.diagnose(before)
    print(f"one look: {look.verdict} {', '.join(look.named)}")
    after = luztar.fit(before.model + look.named[0], runs)
    print(f"unseen error {before.error.held_out_rms:.4f} -> {after.error.held_out_rms:.4f} {after.error.unit}")
    print(luztar.compare(after))


if __name__ == "__main__":
    main()
