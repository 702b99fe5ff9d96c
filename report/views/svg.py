"""A matplotlib figure as SVG for a page: texts as text, paths in steps, the ticks of an axis as one path."""

from __future__ import annotations

import base64
import io
import re
from html import escape
from typing import Any

import numpy as np
from matplotlib.backend_bases import RendererBase
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.image import imsave
from matplotlib.path import Path
from matplotlib.transforms import Affine2D

from ..document.notation import Notation, fragments, read

Clip = tuple[float, float, float, float] | None

_LOOKS = 'font-family="DejaVu Sans, Verdana, Noto Sans, Arial, sans-serif" stroke-linejoin="round"'
_HATCH = 72
"""The side of a tile of a hatched area."""


def written(figure: Figure, prefix: str) -> str:
    """The SVG of a figure that is laid out, without anything to load.

    What is referred to in it is called `prefix` and a number, so that several pictures can stand in one page.
    """
    figure.set_dpi(72)  # then places are points of print
    writer = _Writer(figure.bbox.width, figure.bbox.height, prefix)
    figure.draw(writer)
    return writer.svg()


class _Writer(RendererBase):
    """Writes what matplotlib draws."""

    def __init__(self, width: float, height: float, prefix: str) -> None:
        super().__init__()
        self.size, self.prefix = (width, height), prefix
        self.flip = Affine2D().scale(1, -1).translate(0, height)
        self.parts: list[str] = []
        self.defined: list[tuple[str, str]] = []
        self.lines: dict[str, str] | None = None

    def svg(self) -> str:
        """The whole picture."""
        (width, height), (wide, high) = self.size, (round(length * 4 / 3) for length in self.size)
        opening = f'<svg xmlns="http://www.w3.org/2000/svg" {_LOOKS} width="{wide}" height="{high}"'
        defs = "".join(f'{one} id="{self.prefix}{n}"{rest}' for n, (one, rest) in enumerate(self.defined))
        defs = f"<defs>{defs}</defs>" if defs else ""
        return f'{opening} viewBox="0 0 {width:.1f} {height:.1f}">{"".join(self.parts)}{defs}</svg>'

    # --- what matplotlib asks a renderer for ---

    def get_canvas_width_height(self) -> tuple[float, float]:
        return self.size

    def get_text_width_height_descent(self, s: str, prop: Any, ismath: Any) -> tuple[float, float, float]:
        found: tuple[float, float, float] = self._text2path.get_text_width_height_descent(s, prop, ismath)
        return found

    def open_group(self, s: str, gid: str | None = None) -> None:
        if s == "matplotlib.axis":
            self.lines = {}

    def close_group(self, s: str) -> None:
        if s == "matplotlib.axis" and self.lines is not None:
            self.parts += [f'<path d="{d}" style="{style}"/>' for style, d in self.lines.items()]
            self.lines = None

    def draw_path(self, gc: Any, path: Path, transform: Any, rgbFace: Any = None) -> None:
        rgbFace = rgbFace if np.shape(path.vertices)[0] > 2 else None  # a tick has no inside
        open_ = rgbFace is None and gc.get_hatch() is None
        d = _way(path, transform + self.flip, (0.0, 0.0, *self.size) if open_ else None, simplify=open_)
        style = self._style(gc, rgbFace)
        if d and open_ and self.lines is not None:
            self.lines[style] = self.lines.get(style, "") + d.replace("m", "M", 1)
        elif d:
            self.parts.append(f'<path d="{d}"{self._clip(gc, path, transform)} style="{style}"/>')

    def draw_image(self, gc: Any, x: float, y: float, im: Any, transform: Any = None) -> None:
        buffer = io.BytesIO()
        imsave(buffer, im[::-1], format="png", metadata={"Software": ""})
        height, width = im.shape[:2]
        place = f'x="{x:.1f}" y="{self.size[1] - y - height:.1f}" width="{width}" height="{height}"'
        data = base64.b64encode(buffer.getvalue()).decode()
        self.parts.append(f'<image {place} href="data:image/png;base64,{data}"/>')

    def draw_text(
        self,
        gc: Any,
        x: float,
        y: float,
        s: str,
        prop: Any,
        angle: float,
        ismath: Any = False,
        mtext: Any = None,
    ) -> None:
        letters = _letters(s) if ismath else escape(s, quote=False)
        if letters is None:  # notation in two dimensions: as it was drawn
            super().draw_text(gc, x, y, s, prop, angle, ismath, mtext)
            return
        place = f'x="{x:.1f}" y="{y:.1f}"'
        if angle:
            place = f'transform="translate({x:.1f},{y:.1f}) rotate({-angle:g})"'
        # A few characters are as wide in any font, near enough.
        wide = self.get_text_width_height_descent(s, prop, ismath)[0]
        fitted = f' textLength="{wide:.1f}"' if len(s) > 5 else ""
        style = f"font-size:{prop.get_size_in_points():g}px;fill:{to_hex(gc.get_rgb())}"
        self.parts.append(f'<text {place}{fitted} style="{style}">{letters}</text>')

    # --- styles and what they refer to ---

    def _style(self, gc: Any, face: Any) -> str:
        found = {"fill": "none" if face is None else to_hex(face)}
        if gc.get_hatch() is not None:
            found = {"fill": f"url(#{self._hatch(gc, face)})"}
        elif face is not None:
            found["fill-opacity"] = _opacity(gc, face)
        if gc.get_linewidth():
            found |= {"stroke": to_hex(gc.get_rgb()), "stroke-width": f"{gc.get_linewidth():g}"}
            offset, dashes = gc.get_dashes()
            found["stroke-dasharray"] = ",".join(f"{dash:g}" for dash in (() if dashes is None else dashes))
            found["stroke-dashoffset"] = f"{offset:g}" if offset else ""
            found["stroke-opacity"] = _opacity(gc, gc.get_rgb())
            # As the picture has it unless something else is said.
            found["stroke-linejoin"] = gc.get_joinstyle().removeprefix("round")
            found["stroke-linecap"] = gc.get_capstyle().removeprefix("butt").replace("projecting", "square")
        return ";".join(f"{name}:{value}" for name, value in found.items() if value)

    def _define(self, before: str, inside: str) -> str:
        """The name of what is referred to, defined once."""
        if (before, inside) not in self.defined:
            self.defined.append((before, inside))
        return f"{self.prefix}{self.defined.index((before, inside))}"

    def _hatch(self, gc: Any, face: Any) -> str:
        colour, width = to_hex(gc.get_hatch_color()), gc.get_hatch_linewidth()
        to_tile = Affine2D().scale(_HATCH, -_HATCH).translate(0, _HATCH)
        d = _way(gc.get_hatch_path(), to_tile, None, simplify=False)
        below = "" if face is None else f'<rect width="{_HATCH}" height="{_HATCH}" fill="{to_hex(face)}"/>'
        style = f"fill:{colour};stroke:{colour};stroke-width:{width:g}"
        size = f'patternUnits="userSpaceOnUse" width="{_HATCH}" height="{_HATCH}"'
        return self._define("<pattern", f' {size}>{below}<path d="{d}" style="{style}"/></pattern>')

    def _clip(self, gc: Any, path: Path, transform: Any) -> str:
        """The frame that a path is cut off at, if it reaches beyond it."""
        frame = gc.get_clip_rectangle()
        if frame is None:
            return ""
        box = path.get_extents(transform)
        if frame.x0 <= box.x0 and box.x1 <= frame.x1 and frame.y0 <= box.y0 and box.y1 <= frame.y1:
            return ""
        place = f'x="{frame.x0:.1f}" y="{self.size[1] - frame.y1:.1f}"'
        rect = f'<rect {place} width="{frame.width:.1f}" height="{frame.height:.1f}"/>'
        return f' clip-path="url(#{self._define("<clipPath", f">{rect}</clipPath>")})"'


def _opacity(gc: Any, colour: tuple[float, ...]) -> str:
    """Of a colour, unless it is the same for all; nothing for an opaque one."""
    found = gc.get_alpha() if gc.get_forced_alpha() else [*colour, 1.0][3]
    return "" if found == 1 else f"{found:g}"


# --- paths -----------------------------------------------------------------------------------------------

_COMMANDS = {Path.MOVETO: "m", Path.LINETO: "l", Path.CURVE3: "q", Path.CURVE4: "c", Path.CLOSEPOLY: "z"}


def _way(path: Path, transform: Any, clip: Clip, *, simplify: bool) -> str:
    """A path in steps from place to place, in tenths of a point, 35 µm on paper, so that nothing adds up.

    >>> _way(Path([(0, 0), (10, 0), (10.04, 5.55), (8, 4)]), Affine2D(), None, simplify=False)
    'm0,0h10v5.6l-2-1.6'
    >>> _way(Path([(3, 4), (3, 4)]), Affine2D(), None, simplify=False)
    'm3,4z'
    """
    made, here, start, last = "", (0, 0), (0, 0), ""
    segments = path.iter_segments(transform, clip=clip, simplify=simplify and path.should_simplify)
    for points, code in segments:
        command = _COMMANDS[Path.code_type(code)]
        if command == "z":
            made, here, last = f"{made}z", start, "z"
            continue
        places = [(int(x), int(y)) for x, y in np.rint(np.reshape(points, (-1, 2)) * 10)]
        steps = [step for x, y in places for step in (x - here[0], y - here[1])]
        if command == "l" and not all(steps):
            if not any(steps):  # a dot is a way that ends where it begins
                made, last = (f"{made}z", "z") if last == "m" else (made, last)
                continue
            command, steps = ("v", steps[1:]) if steps[1] else ("h", steps[:1])
        here = places[-1]
        start = here if command == "m" else start
        numbers = ",".join(map(_tenths, steps)).replace(",-", "-")
        # A command that is told once holds for all that follow.
        again = command == last != "m"
        made += ("" if numbers[0] == "-" else ",") + numbers if again else command + numbers
        last = command
    return made


def _tenths(number: int) -> str:
    whole, tenth = divmod(abs(number), 10)
    text = (str(whole) if whole or not tenth else "") + (f".{tenth}" if tenth else "")
    return f"-{text}" if number < 0 else text


# --- texts -----------------------------------------------------------------------------------------------

_DRAWN = {"fraction", "root", "limits", "under", "cases", "accent", "upright"}
"""Notation that no letters beside one another tell, and commands that are not known here."""
_SHIFTS = {"_": 1.5, "^": -3.0}


def _letters(text: str) -> str | None:
    """A text as SVG: what stands between dollar signs is slanted, lowered or raised; None if it is more."""
    made, low = "", 0.0
    for place, part in enumerate(re.split(r"(?<!\\)\$", re.sub(r"\\mathdefault\{(.*?)\}\$", r"\1$", text))):
        if place % 2 and not _is_flat(read(part)):
            return None
        pieces = fragments(part) if place % 2 else [("", part.replace(r"\$", "$"))]
        for height, piece in pieces if part else ():
            to = _SHIFTS.get(height, 0.0)
            style = ' font-style="italic"' if place % 2 and re.search(r"[^\W\d]", piece) else ""
            style += f' dy="{to - low:g}"' if to != low else ""
            style += ' font-size="70%"' if height else ""
            letters = escape(piece, quote=False)
            made += f"<tspan{style}>{letters}</tspan>" if style else letters
            low = to
    return made


def _is_flat(part: Notation) -> bool:
    return part.kind not in _DRAWN and all(map(_is_flat, part.parts))
