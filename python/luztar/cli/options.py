"""The options, each described once and shared by the commands that have it."""

from __future__ import annotations

from typing import Annotated

import typer

Files = Annotated[list[str], typer.Argument(metavar="RUN", help="Run files: CSV (also .gz), AB Dynamics text, MAT.")]
ModelName = Annotated[
    str,
    typer.Option(
        "--model", metavar="M", help="A built-in structure (rig, axis) or a model file (TOML; also steering, car)."
    ),
]
Map = Annotated[
    list[str],
    typer.Option("--map", metavar="K=COL", help='Column of a channel: angle="SR Angle", torque="ADC6*0.52".'),
]
Unit = Annotated[
    list[str], typer.Option("--unit", metavar="K=UNIT", help="Unit of a channel where the file has none: force=N.")
]
HeldOut = Annotated[
    list[str],
    typer.Option("--held-out", metavar="RUN", help="A run that is only predicted and decides nothing."),
]
Band = Annotated[
    float | None,
    typer.Option(
        "--band",
        metavar="HZ",
        help="Upper edge of the comparison. Default: 6 for rig, 40 for axis; none for steering and car.",
    ),
]
Resample = Annotated[
    float | None, typer.Option("--resample", metavar="HZ", help="Bring unevenly sampled runs to this rate.")
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
Report = Annotated[
    str | None, typer.Option("--report", metavar="F.html", help="Also write a report, one self-contained HTML file.")
]
Debug = Annotated[bool, typer.Option("--debug", help="Show the whole traceback of an error.")]
