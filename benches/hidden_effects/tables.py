"""The sections of the page that hold one table each."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from .cases import EFFECTS, NOISES, OUTSIDE
from .markdown import table
from .tally import Record, coverage, distinct, median, misnamed, of_kind, rate


def naming(records: Sequence[Record]) -> str:
    """Return names by effect and size."""
    mine = of_kind(records, "effect")
    if not mine:
        return ""
    rows = []
    for effect in EFFECTS:
        for size in sorted({r["size"] for r in mine}, reverse=True):
            here = [r for r in mine if r["effect"] == effect and r["size"] == size]
            if not here:
                continue
            said = ", ".join(f"{what} {n}" for what, n in misnamed(here).most_common(3)) or "—"
            ratio = f"{median([r['before'] for r in here]):.2f} → {median([r['after'] for r in here]):.2f}"
            alike = median([r["cosine"] for r in here])
            nearest = Counter(next(iter(r["rivals"]), "—") for r in here).most_common(1)[0][0]
            counts = (rate(here, lambda r: r["said_missing"]), rate(here, lambda r: r["exact"]))
            in_set = rate(here, lambda r: r["in_set"])
            rival = f"{alike:.2f} {nearest}" if alike == alike else "—"
            rows.append((effect, f"{size:g}", *(c.short for c in counts), in_set.short, ratio, rival, said))
    small = [r for r in mine if r["size"] == 0.3 and not distinct(r)]
    head = (
        "Effect",
        "Size",
        "Something missing",
        "Exact",
        "In a set ≤ 3",
        "Error / floor",
        "Nearest rival",
        "Else said",
    )
    return (
        "## Names\n\nExact: the study added this one effect and nothing else. Error / floor: before and after,\n"
        "medians. Nearest rival: the median of the largest cosine that another effect reaches in the same movements;\n"
        f"above 0.9 (at size 0.3: {len(small)} cases) a set is the right answer.\n\n" + table(head, rows)
    )


def outside(records: Sequence[Record]) -> str:
    """Return the verdicts on what the catalogue does not hold."""
    mine = of_kind(records, "outside")
    rows = []
    for effect in OUTSIDE:
        here = [r for r in mine if r["effect"] == effect]
        if here:
            said = Counter("+".join(r["named"]) or r["verdict"].replace("_", " ") for r in here)
            del said["unexplained"]
            other = ", ".join(f"{what} {n}" for what, n in said.most_common(4)) or "—"
            tried = Counter(r["added"][0] for r in here if r["added"]).most_common(1)
            found = rate(here, lambda r: r["verdict"] == "unexplained")
            rows.append((effect, found, other, tried[0][0] if tried else "—"))
    if not rows:
        return ""
    return "## Outside the catalogue\n\n" + table(("Hidden", "Unexplained", "Else said", "Tried first"), rows)


def nothing_hidden(records: Sequence[Record]) -> str:
    """Return false alarms by noise colour and by kind of test."""
    mine = of_kind(records, "null")
    if not mine:
        return ""
    rows = []
    for noise in (*NOISES, None):
        here = [r for r in mine if noise in (None, r["noise"])]
        names = Counter(n for r in here for n in r["named"])
        said = ", ".join(f"{w} {n}" for w, n in names.most_common()) or "—"
        verdicts = Counter(r["verdict"] for r in here if r["verdict"] != "nothing_missing" and not r["named"])
        other = ", ".join(f"{w.replace('_', ' ')} {n}" for w, n in verdicts.most_common()) or "—"
        missing, named = rate(here, lambda r: r["said_missing"]), rate(here, lambda r: r["named"])
        rows.append((noise or "all", missing, named, said, other))
    head = ("Noise", "Something is called missing", "An effect is named", "Which", "Other verdicts")
    text = "## Nothing hidden\n\n" + table(head, rows)
    rows = []
    for kind in dict.fromkeys(k for r in mine for k in r.get("kinds", {})):
        cells = []
        for noise in (*NOISES, None):
            here = [r for r in mine if noise in (None, r["noise"]) and kind in r.get("kinds", {})]
            found = rate(here, lambda r, k=kind: r["kinds"][k][0] <= 0.05)
            cells.append(found if noise is None else found.short)
        strongest = Counter(r["kinds"][kind][1] for r in mine if r.get("kinds", {}).get(kind, (1,))[0] <= 0.05)
        rows.append((kind, *cells, ", ".join(f"{w} {n}" for w, n in strongest.most_common(3)) or "—"))
    head = ("Kind of test, by itself at 5 %", *NOISES, "all", "Strongest where it rejects")
    text = f"{text}\n\n{table(head, rows)}"
    best = sorted(max((c["gain"] for c in r["table"]), default=0.0) for r in mine)
    sure = max(max((c["gain_errors"] for c in r["table"] if c["gain"] >= 0.01), default=0.0) for r in mine)
    most = int(0.95 * (len(best) - 1))
    return (
        f"{text}\n\nBy chance alone the best candidate takes {100 * best[most]:.1f} % off the unseen error in 95 % of "
        f"these cases and {100 * best[-1]:.1f} % at most; where it takes 1 % or more, it is {sure:.1f} standard errors "
        "(paired by stroke) at most."
    )


def intervals(records: Sequence[Record]) -> str:
    """Return the coverage of the 95 % intervals by parameter."""
    null, effect = of_kind(records, "null"), of_kind(records, "effect")
    rows = []
    for what, chosen in (("nothing hidden", null), ("an effect hidden", effect)):
        for key, (found, without) in coverage(chosen).items():
            if key.split(".")[0] in ("offset", "coulomb", "viscous") and found.tries:
                cells = [coverage([r for r in chosen if r["noise"] == n]).get(key) for n in NOISES]
                rows.append((f"{key}, {what}", *(c[0].short if c else "—" for c in cells), found, without))
    for key, (found, without) in coverage(effect).items():
        if key.split(".")[0] not in ("offset", "coulomb", "viscous"):
            cells = [coverage([r for r in effect if r["noise"] == n]).get(key) for n in NOISES]
            rows.append((key, *(c[0].short if c else "—" for c in cells), found, without))
    if not rows:
        return ""
    head = ("Parameter", *NOISES, "Interval holds the truth", "None given or flagged")
    return (
        "## Intervals\n\nThe true model is fitted; counted is every 95 % interval that stands without a warning.\n"
        "The last column counts parameters without an interval or flagged as not identifiable.\n\n" + table(head, rows)
    )


def peers(records: Sequence[Record]) -> str:
    """Return what other programs say of the same records."""
    theirs = [r for r in records if r["peers"] and "failed" not in r]
    if not theirs:
        return "## Other programs\n\nThey were not run for this page (`--peers N`)."
    from .peers import CANDIDATES, IN_LIBRARY, PROGRAMS

    ours = {
        (r["effect"], r["noise"], r["number"], r["size"]): r for r in records if not r["peers"] and "failed" not in r
    }
    can = {"PySINDy": set(IN_LIBRARY), "lmfit + BIC": {c.partition(" ")[0] for c in CANDIDATES}}
    programs = [p for p in PROGRAMS if any(p in r["found"] for r in theirs)]
    pairs = [(r, ours.get((r["effect"], r["noise"], r["number"], r["size"]))) for r in theirs]
    both = [(t, o) for t, o in pairs if o is not None]
    rows = []

    def row(what: str, chosen: list[tuple[Record, Record]], said: str) -> None:
        cells = []
        for p in programs:
            if said == "right":
                known = [t for t, _ in chosen if t["effect"] in can[p]]
                cells.append(rate(known, lambda t, p=p: t["found"][p] == [t["effect"]]))
            else:
                cells.append(rate([t for t, _ in chosen], lambda t, p=p: t["found"][p]))
        mine = rate([o for _, o in chosen], lambda o: o["exact"] if said == "right" else o["named"])
        rows.append((what, mine, *cells))

    for noise in NOISES:
        row(
            f"nothing hidden, {noise}: an effect is named",
            [b for b in both if b[0]["kind"] == "null" and b[0]["noise"] == noise],
            "any",
        )
    row("effects of size 1: exactly that one is named", [b for b in both if b[0]["kind"] == "effect"], "right")
    for p in programs:
        chosen = [b for b in both if b[0]["effect"] in can[p]]
        row(f"the same, only effects that {p} can express ({len(can[p])})", chosen, "right")
    row("outside the catalogue: an effect is named all the same", [b for b in both if b[0]["kind"] == "outside"], "any")
    absent = [p for p in PROGRAMS if p not in programs]
    said = {p: Counter(n for t in theirs if t["kind"] == "null" for n in t["found"].get(p, [])) for p in programs}
    what = "; ".join(f"{p}: {', '.join(f'{n} {k}' for n, k in c.most_common(3)) or 'nothing'}" for p, c in said.items())
    note = f"\n\nNamed where nothing is hidden: {what}."
    note += f"\n\nNot installed where this page was made: {', '.join(absent)}." if absent else ""
    return (
        "## Other programs\n\nThe same records, the same low pass on torque and regressors, 50 samples per second, "
        "only samples that move (above 3 degrees/s).\n"
        "PySINDy: STLSQ with threshold 0.1 on the terms 1, sign v, v, |v|, v|v|, x, x³, sin x, cos x,\n"
        "exp(-(v/0.1)²) sign v; named is every effect whose term it keeps. "
        "lmfit: friction held at rest, each candidate refitted alone, the\n"
        "best named where its BIC is lower by more than 10. Their rates of right names count only\n"
        "effects that they can express; luztar's count all.\n\n" + table(("Case", "luztar", *programs), rows) + note
    )
