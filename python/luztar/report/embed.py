"""Values and scripts inside HTML: JSON that cannot end its script, and the hash that lets a script run."""

from __future__ import annotations

import base64
import gzip
import hashlib
import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import MissingError


def plain_values(value: Any) -> Any:
    """Return a value as JSON knows it: arrays as lists, numbers that are not finite as None."""
    if isinstance(value, Mapping):
        return {str(k): plain_values(v) for k, v in value.items()}
    if isinstance(value, np.ndarray):
        return plain_values(value.tolist())
    if isinstance(value, list | tuple):
        return [plain_values(v) for v in value]
    if isinstance(value, np.generic):
        return plain_values(value.item())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value


def safe_json(value: Any) -> str:
    """Return JSON that may stand inside a script element, whatever names it holds.

    ``<``, ``>`` and ``&`` are written as escapes of JSON itself: no text can end the element or begin a comment.
    """
    text = json.dumps(plain_values(value), allow_nan=False, ensure_ascii=True, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def safe_script(text: str) -> str:
    """Return a script's text so that no string in it can end its element."""
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    return text.replace("</script", "<\\/script").replace("<!--", "<\\!--")


def library() -> str:
    """Return the picture library as it may stand in a script.

    Raises
    ------
    MissingError
        plotly is not installed.
    """
    try:
        from plotly.offline import get_plotlyjs  # type: ignore[import-untyped]
    except ImportError as error:
        raise MissingError("a report needs plotly", "report", "pip install plotly") from error
    return safe_script(get_plotlyjs())


def drawing() -> str:
    """Return the script that unpacks the library and draws the figures of a page."""
    return safe_script((Path(__file__).parent / "draw.js").read_text(encoding="utf-8"))


def packed(text: str) -> str:
    """Return a text compressed (gzip) and in letters that can stand anywhere (base64); the same every time.

    The picture library is 4.8 MB of a report, and the parts it could be shipped in are not in its Python package; what
    is left of it packed is 1.9 MB, and every browser since 2023 unpacks it (DecompressionStream).
    """
    return base64.b64encode(gzip.compress(text.encode(), compresslevel=9, mtime=0)).decode()


def script_hash(text: str) -> str:
    """Return what the content security policy calls a script that may run."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
