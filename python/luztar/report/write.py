"""Writing the report: one HTML file that needs nothing but a browser."""

from __future__ import annotations

import os
import tempfile
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import LuztarError, MissingError, ParameterError
from . import content, embed
from .figures_of import figures_of

if TYPE_CHECKING:
    from ..diagnosis.study import Study
    from ..tb038.check import Check

HERE = Path(__file__).parent


def write_report(
    path: str | os.PathLike[str],
    *,
    study: Study | None = None,
    check: Check | None = None,
) -> None:
    """Write a study, a TB 038 check or both as one self-contained HTML file.

    The file holds its scripts and figures, fetches nothing, and carries the results as JSON
    (``<script type="application/json" id="luztar-study">``, ``luztar-tb038``, ``luztar-provenance``). It is written
    beside its place first and then moved there, so that a report is never half there.

    Parameters
    ----------
    path : path
        An existing file is replaced.
    study : Study, optional
        From ``luztar.study``.
    check : Check, optional
        From ``luztar.tb038.evaluate``. Where a study of a rig is given without one, its runs are checked here; runs
        that cannot be checked become a sentence in the report.

    Raises
    ------
    ParameterError
        Neither a study nor a check is given, or the folder does not exist.
    MissingError
        jinja2 or plotly is not installed.
    """
    if study is None and check is None:
        raise ParameterError("there is nothing to report", "study", "Give a study, a check or both.")
    target = Path(path)
    if not target.parent.is_dir():
        raise ParameterError("there is no such folder", str(target.parent), "Make it first.")
    check, not_checked = (check, None) if check is not None else _check_of(study)
    put_in_place(target, page(study, check, not_checked))


def page(study: Study | None, check: Check | None, not_checked: str | None = None) -> str:
    """Return the report as HTML text.

    Parameters
    ----------
    study, check
        As for :func:`write_report`.
    not_checked : str, optional
        Why the runs could not be checked.
    """
    try:
        from jinja2 import Environment, FileSystemLoader, StrictUndefined
        from markupsafe import Markup
    except ImportError as error:
        raise MissingError("a report needs jinja2 and plotly", "report", "pip install jinja2 plotly") from error

    plotly_js, draw_js = embed.library(), embed.drawing()
    provenance = content.provenance(study, check, datetime.now().astimezone())
    figures = figures_of(study, check)
    data: dict[str, Any] = {
        "luztar-study": study.to_dict() if study else None,
        "luztar-tb038": check.to_dict() if check else None,
        "luztar-provenance": provenance,
        "luztar-figures": figures,
    }
    environment = Environment(
        loader=FileSystemLoader(HERE), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    # Only what is written or escaped here is marked as safe; every name and text goes through autoescape.
    return environment.get_template("report.html.jinja").render(
        content.sections(study, check, not_checked, provenance),
        figures=figures,
        css=Markup((HERE / "report.css").read_text(encoding="utf-8")),
        data={key: Markup(embed.safe_json(value)) for key, value in data.items() if value is not None},
        plotly_packed=Markup(embed.packed(plotly_js)),
        draw_js=Markup(draw_js),
        script_hashes=Markup(f"{embed.script_hash(plotly_js)} {embed.script_hash(draw_js)}"),
    )


def put_in_place(target: Path, text: str) -> None:
    """Write a file beside its place and move it there: whoever looks sees the old one or the whole new one."""
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", suffix=".part")
    try:
        # A fixed line end: the scripts' hashes are of the text as it stands here.
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        # A temporary file is the owner's alone; a report has the rights of any new file.
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(name, 0o666 & ~mask)
        os.replace(name, target)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def _check_of(study: Study | None) -> tuple[Check | None, str | None]:
    if study is None or study.model.structure_name != "rig":
        return None, None
    from ..tb038 import evaluate

    try:
        return evaluate(study.runs), None
    except LuztarError as error:
        return None, str(error)
