"""A picture in fewer bytes: texts as text, styles told once, paths in steps. It looks the same."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import pairwise

__all__ = ["inlined", "short_svg"]

_SVG = "http://www.w3.org/2000/svg"
_PATH = re.compile(r' d="(M[^"]*)"')
_STEP = re.compile(r"([MLQCzhHvV])|(-?\d+(?:\.\d+)?)")
_COUNTS = {"M": 2, "L": 2, "Q": 4, "C": 6, "h": 1}


def short_svg(svg: str, prefix: str = "a") -> str:
    """An SVG without comments, idle groups and names, its paths told in steps from place to place.

    What is referred to in it is called `prefix` and a number.
    """
    text = svg.replace("xlink:href", "href").replace(' xmlns:xlink="http://www.w3.org/1999/xlink"', "")
    text = text.replace(' version="1.1"', "").replace("#ffffff", "#fff")
    text = _with_texts(text)
    text = re.sub(r"<!--[\s\S]*?-->|<\?xml[^>]*\?>", "", text)
    text = re.sub(r">\s+<", "><", text.strip())
    used = set(re.findall(r'(?:href="|url\()#([^")]+)', text))
    names = {name: f"{prefix}{number:x}" for number, name in enumerate(sorted(used))}
    text = re.sub(r' id="([^"]*)"', lambda f: f' id="{names[f[1]]}"' if f[1] in names else "", text)
    text = re.sub(r'(href="|url\()#([^")]+)', lambda f: f"{f[1]}#{names[f[2]]}", text)
    text = re.sub(r' style="[^"]*"', lambda found: re.sub(r"([:;]) +", r"\1", found.group()), text)
    text = _PATH.sub(lambda found: f' d="{_relative(found[1])}"', text)
    text = re.sub(r"translate\([^)]*\)", _rounded, text)
    text = re.sub(r'<text transform="translate\(([-\d.]+),([-\d.]+)\)"', r'<text x="\1" y="\2"', text)
    text = _with_lines(text)
    while True:
        # A group without attributes does nothing.
        less = re.sub(r"<g>((?:(?!</?g\b)[\s\S])*)</g>", r"\1", text)
        if less == text:
            return text
        text = less


# --- texts -----------------------------------------------------------------------------------------------

_TEXT = re.compile(
    r"<!-- (?P<text>(?:(?!-->)[\s\S])*) -->\s*"
    r'<g style="fill: (?P<fill>#\w+)" transform="(?P<where>translate\([^)]*\)(?: rotate\([^)]*\))?) '
    r'scale\((?P<scale>[\d.]+) -[\d.]+\)">\s*'
    r"(?P<glyphs>(?:<defs>[\s\S]*?</defs>\s*)?(?:<use [^>]*/>\s*)+)</g>"
)
_USE = re.compile(
    r'<use href="#([^"]*)"(?: transform="translate\(([-\d.]+) [-\d.]+\)(?: scale\(([\d.]+)\))?")?/>'
)
_GLYPH = re.compile(r'<path id="([^"]*)" d="[^"]*" transform="scale\(0.015625\)"/>')
_PLAIN = 61.0
"""The width of most letters, in hundredths of the size."""
_OTHER = {"m": 97.0, "w": 82.0, "W": 99.0, "M": 86.0, "i": 28.0, "l": 28.0, "j": 28.0, "r": 41.0, "t": 39.0}
_GREEK = {"alpha": "α", "beta": "β", "mu": "µ"}
_MATH = re.compile(r"\\(?P<greek>[a-z]+)|_(?P<low>\w)|(?P<prime>')|(?P<letter>[A-Za-z])|(?P<other>.)")


def _with_texts(svg: str) -> str:
    """The picture with texts in place of the outlines that they were drawn with."""
    widths: dict[str, float] = {}
    for found in _TEXT.finditer(svg):
        uses = _USE.findall(found["glyphs"])
        for (name, at, size), (_, there, _) in pairwise(uses):
            if not size:
                widths.setdefault(name, float(there or 0) - float(at or 0))
    glyphs = {found[1]: found.group() for found in _GLYPH.finditer(svg)}

    def written(found: re.Match[str]) -> str:
        said = _said(found["text"])
        if said is None:
            return found.group()
        name, at, size = _USE.findall(found["glyphs"])[-1]
        last = _OTHER.get(found["text"].rstrip("$")[-1:], _PLAIN)
        width = (float(at or 0) + widths.get(name, last) * float(size or 1)) * float(found["scale"])
        # A few characters are as wide in any font, near enough.
        fitted = f'textLength="{width:.1f}" ' if len(found["text"]) > 5 else ""
        return (
            f'<text transform="{found["where"]}" {fitted}'
            f'style="font-size:{100 * float(found["scale"]):g}px;fill:{found["fill"]}">{said}</text>'
        )

    text = _TEXT.sub(written, svg)
    if text == svg:
        return svg
    # What is still drawn may need outlines that stood beside one of the others.
    text = _GLYPH.sub("", text)
    needed = [glyph for name, glyph in glyphs.items() if f'href="#{name}"' in text]
    defs = f"<defs>{''.join(needed)}</defs>" if needed else ""
    text = re.sub(r"<defs>\s*</defs>", "", text)
    return re.sub(r"(<svg\b[^>]*>)", rf"\1{defs}", text, count=1)


def _said(text: str) -> str | None:
    """A text of matplotlib in SVG: what stands between dollar signs is set as mathematics."""
    made = ""
    for place, part in enumerate(text.split("$")):
        if place % 2 == 0:
            made += part
            continue
        lowered = ""
        for found in _MATH.finditer(part):
            if found["greek"] and found["greek"] not in _GREEK:
                return None
            shift = f' dy="{"-" if lowered else ""}1.5"' if bool(lowered) != bool(found["low"]) else ""
            size = ' font-size="70%"' if found["low"] else ""
            lowered = found["low"] or ""
            if found["prime"]:
                made += "′"
            elif found["other"]:
                made += found["other"]
            else:
                letter = _GREEK[found["greek"]] if found["greek"] else found["low"] or found["letter"]
                made += f'<tspan font-style="italic"{shift}{size}>{letter}</tspan>'
        rest = text.split("$")[place + 1]
        if lowered and rest:
            made += '<tspan dy="-1.5">\u200b</tspan>'
    return made


# --- lines ---------------------------------------------------------------------------------------------

_MARKER = re.compile(
    r'<defs><path id="(?P<name>[^"]*)" d="m0,0(?P<steps>[^"mz]*)"(?P<style> style="[^"]*")/></defs>'
)
_LINE = re.compile(r'<path d="m(?P<path>[-\d.,]+l[-\d.,]+)"(?P<style> style="[^"]*")/>')


def _with_lines(svg: str) -> str:
    """The picture with each tick as a line, and all lines of one style as one path where the first stands.

    Only straight lines that are not clipped: those of the grid and of the axes, below all that is drawn.
    """
    for marker in list(_MARKER.finditer(svg)):
        use = re.compile(rf'<use href="#{marker["name"]}" x="([^"]*)" y="([^"]*)"[^>]*/>')
        svg = use.sub(
            rf'<path d="m\1,\2{marker["steps"]}"{marker["style"]}/>', svg.replace(marker.group(), "")
        )
    lines: dict[str, list[str]] = {}
    for found in _LINE.finditer(svg):
        lines.setdefault(found["style"], []).append(found["path"])

    def joined(found: re.Match[str]) -> str:
        paths = lines.pop(found["style"], [])
        return f'<path d="M{"M".join(paths)}"{found["style"]}/>' if paths else ""

    return _LINE.sub(joined, svg)


# --- styles ----------------------------------------------------------------------------------------------


_STYLE = re.compile(r' style="([^"]*)"')


def inlined(svgs: Mapping[str, str]) -> tuple[dict[str, str], str]:
    """Pictures that stand in one page, by their names, and the style sheet that they share.

    What a picture calls its parts is told apart from what the others do, each style is told once, and what is
    the same for all (the font, how lines join) is for the sheet of the page to say.
    """
    short = {name: short_svg(svg, f"d{place}-") for place, (name, svg) in enumerate(svgs.items())}
    short = {name: re.sub(r"<defs><style\b[\s\S]*?</style></defs>", "", svg) for name, svg in short.items()}
    styles = dict.fromkeys(style for svg in short.values() for style in _STYLE.findall(svg))
    names = {style: f"s{number:x}" for number, style in enumerate(styles)}
    return {
        name: _STYLE.sub(lambda found: f' class="{names[found[1]]}"', svg).replace(f' xmlns="{_SVG}"', "", 1)
        for name, svg in short.items()
    }, "".join(f".{name}{{{style}}}" for style, name in names.items())


# --- paths -----------------------------------------------------------------------------------------------


def _rounded(found: re.Match[str]) -> str:
    """Shifts to a hundredth of a point."""
    text = found.group().replace(" ", ",")
    return re.sub(r"-?\d+\.\d{3,}", lambda n: f"{float(n[0]):.2f}".rstrip("0").rstrip("."), text)


def _relative(path: str) -> str:
    """A path of absolute places as steps, exactly: in hundredths, so that nothing adds up."""
    tokens = [found.groups() for found in _STEP.finditer(path)]
    if any(command is None and _long(number) for command, number in tokens):
        return path
    made: list[str] = []
    here = start = (0, 0)
    place, last = 0, ""
    while place < len(tokens):
        command = tokens[place][0]
        if command is None:
            command = "L" if last == "M" else last
        else:
            place += 1
        if command == "z":
            made.append("z")
            here, last = start, "z"
            continue
        count = _COUNTS.get(command)
        numbers = [tokens[n][1] for n in range(place, place + (count or 0)) if n < len(tokens)]
        if count is None or len(numbers) < count or None in numbers:
            return path
        place += count
        whole = [_hundredths(number) for number in numbers]
        if command == "h":
            steps, here = whole, (here[0] + whole[0], here[1])
        else:
            steps = [value - here[n % 2] for n, value in enumerate(whole)]
            here = (whole[-2], whole[-1])
        if command == "M":
            start = here
        letter = command.lower()
        made.append(("" if letter == last.lower() and letter not in "mz" else letter) + _joined(steps))
        last = command
    # A command that is told once holds for all that follow; a sign parts two numbers as a space does.
    parted = (f" {piece}" if piece[0] in ".0123456789" else piece for piece in made)
    # A comma parts as well as a space does, and an address can hold it.
    return "".join(parted).replace(" -", "-").replace(" ", ",")


def _long(number: str | None) -> bool:
    return number is not None and len(number.partition(".")[2]) > 2


def _hundredths(number: str | None) -> int:
    whole, _, fraction = (number or "0").partition(".")
    size = int(whole.lstrip("-") or 0) * 100 + int(fraction.ljust(2, "0") or 0)
    return -size if whole.startswith("-") else size


def _joined(steps: list[int]) -> str:
    return " ".join(_printed(step) for step in steps)


def _printed(hundredths: int) -> str:
    size = abs(hundredths)
    fraction = f"{size % 100:02d}".rstrip("0")
    text = (str(size // 100) if size >= 100 or not fraction else "") + (f".{fraction}" if fraction else "")
    return f"-{text}" if hundredths < 0 else text
