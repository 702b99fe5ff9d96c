"""What distinguishes two results, for a terminal and for a pull request."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence

from ..archive.differences import Differences, Move, OtherChange
from ..messages.diagnostics import visible
from ..quantity import behind
from . import markdown as md

_WIDTH = 16
"""Characters of a name at least, so that values stand below each other."""


def as_text(found: Differences, most: int) -> str:
    """Lines for a terminal.

    `most`: how many numbers, and how many of each other kind, are named; the rest are counted.
    """
    lines = [f"numbers    {_count(found)}"]
    width = max([_WIDTH, *(len(move.named) for move in found.moved[:most])])
    for move in found.moved[:most]:
        was, now, by = moved(move)
        now += behind(move.unit)
        lines.append(f"  {move.kind:6}   {move.named:{width}} {was} -> {now}   {by}".rstrip())
    lines += _rest([move.address for move in found.moved], most)
    for word, changes in _others(found):
        for change in changes[:most]:
            lines.append(f"{word:10} {change.name}: {_said(change.before)}")
            lines.append(f"{'':10} {'':{len(change.name)}}  -> {_said(change.after)}")
        lines += _rest([change.name for change in changes], most)
    for word, names in (("added", found.added), ("removed", found.removed)):
        lines += [f"{word:10} {', '.join(names[:most])}"] if names else []
        lines += _rest(names, most)
    lines += [f"{'order':10} {told}" for told in reordered(found)]
    lines.append(_verdict(found))
    return "".join(f"{visible(line)}\n" for line in lines)


def _others(found: Differences) -> tuple[tuple[str, Sequence[OtherChange]], ...]:
    return (
        ("method", found.method),
        ("row", found.rows),
        ("published", found.published),
        ("check", found.checks),
        ("printed", found.printed),
    )


def reordered(found: Differences) -> list[str]:
    """A sentence for each index set whose rows stand in another order."""
    return [f"the {rows} stand in another order: they are compared by their words" for rows in found.order]


def _count(found: Differences) -> str:
    total = found.same + found.noise + len(found.moved)
    return f"{total} in both: {found.same} the same, {found.noise} within rounding, {len(found.moved)} moved"


def _verdict(found: Differences) -> str:
    if found.any:
        return "different"
    return "the same within rounding" if found.noise else "the same"


def _rest(names: Sequence[str], most: int) -> list[str]:
    """A line that counts, by column, what is not named."""
    left = Counter(re.sub(r"\[.*\]", "", name) for name in names[most:])
    if not left:
        return []
    return [f"           and {left.total()} more: {', '.join(f'{name} ({n})' for name, n in left.items())}"]


def _said(text: str) -> str:
    return text or "(none)"


def moved(move: Move) -> tuple[str, str, str]:
    """Both values, with as many digits as it takes to tell them apart, and by how much.

    >>> moved(Move("alpha_mean", "1", "result", 1.30256, 1.30277, ("ok", "ok")))
    ('1.30256', '1.30277', '+0.0161 %')
    >>> moved(Move("x", "m", "moved", 1.0, 1.0 + 2**-40, ("ok", "ok")))
    ('1', '1.0000000000009095', '+9.1e-13 of it')
    >>> moved(Move("x", "m", "moved", 1.0, None, ("ok", "#NOROOT!")))
    ('1', '#NOROOT!', '')
    >>> moved(Move("t", "degC", "result", 20.0, 20.25, ("ok", "ok"), (0.25, "K")))
    ('20', '20.25', '+0.25 K')
    """
    was, now = move.before, move.after
    if was == now and move.status[0] != move.status[1]:
        was = now = None
    if was is None or now is None:
        return _value(was, move.status[0], 6), _value(now, move.status[1], 6), ""
    digits = next((d for d in range(6, 17) if f"{was:.{d}g}" != f"{now:.{d}g}"), 17)
    by = move.relative
    if move.by is not None:
        difference, unit = move.by
        said = f"{difference:+.3g} {unit}"
    elif by is None:
        said = ""
    elif abs(by) >= 1e-6:
        said = f"{100 * by:+.3g} %"
    else:
        said = f"{by:+.1e} of it"
    return _value(was, "", digits), _value(now, "", digits), said


def _value(value: float | None, status: str, digits: int) -> str:
    if value is None:
        return status
    return repr(value).removesuffix(".0") if digits > 12 else f"{value:.{digits}g}"


def as_markdown(found: Differences, most: int) -> str:
    """Tables for a pull request; the arguments are those of :func:`as_text`."""
    text = f"### {md.code(found.before)} and {md.code(found.after)}: {_verdict(found)}\n\n{_count(found)}\n"
    rows = []
    for move in found.moved[:most]:
        was, now, by = moved(move)
        now += behind(move.unit)
        rows.append([md.code(move.named), move.kind, md.cell(was), md.cell(now), md.cell(by)])
    text += _section(["number", "", "before", "after", "by"], rows, [m.address for m in found.moved], most)
    for word, changes in _others(found):
        rows = [[md.code(c.name), md.code(_said(c.before)), md.code(_said(c.after))] for c in changes[:most]]
        text += _section([word, "before", "after"], rows, [change.name for change in changes], most)
    for word, names in (("added", found.added), ("removed", found.removed)):
        text += _section([word], ([md.code(name)] for name in names[:most]), names, most)
    return text + "".join(f"\n{md.cell(told)}\n" for told in reordered(found))


def _section(header: Sequence[str], rows: Iterable[Sequence[str]], names: Sequence[str], most: int) -> str:
    if not names:
        return ""
    rest = "".join(f"\n{md.cell(line.strip())}\n" for line in _rest(names, most))
    return f"\n{md.table(header, rows)}{rest}"


FORMATS: dict[str, Callable[[Differences, int], str]] = {"text": as_text, "markdown": as_markdown}
