"""The table of what was measured, each figure beside its floor."""

import json
from dataclasses import asdict, dataclass, field
from statistics import median


@dataclass
class Row:
    """One line: values and floors of the rounds, in pairs."""

    what: str
    unit: str
    floor_is: str
    values: list
    floors: list
    at_most: float | None = None
    at_least: float | None = None
    note: str = ""
    ratio: float = field(init=False)
    kept: bool = field(init=False)

    def __post_init__(self):
        # Of the pairs, not of the medians: a round's two figures saw the same machine.
        self.ratio = median(value / floor for value, floor in zip(self.values, self.floors, strict=True))
        self.kept = (self.at_most is None or self.ratio <= self.at_most) and (
            self.at_least is None or self.ratio >= self.at_least
        )


def within(what, unit, values, limit, note=""):
    """A row whose limit is a number of the unit rather than a ratio."""
    return Row(what, unit, "limit", values, [limit] * len(values), at_most=1.0, note=note)


def number(value):
    """Three digits and no power of ten, where they are enough."""
    return f"{value:.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def line(row):
    """As a line of Markdown."""
    limit = f"≤ {row.at_most:g}" if row.at_most is not None else f"≥ {row.at_least:g}" if row.at_least is not None else ""
    verdict = ("kept" if row.kept else "MISSED") if limit else ""
    value, floor = number(median(row.values)), number(median(row.floors))
    cells = [row.what, f"{value} {row.unit}", f"{floor} {row.unit}: {row.floor_is}", number(row.ratio), limit, verdict, row.note]
    return "| " + " | ".join(cells) + " |"


HEAD = "| what | measured | floor | ratio | limit | verdict | remark |\n| --- | --- | --- | --- | --- | --- | --- |"


def write(rows, file):
    """All rounds of all rows as JSON."""
    with open(file, "w", encoding="utf-8") as out:
        json.dump([asdict(row) for row in rows], out, indent=1, ensure_ascii=False)


def slope(times, values):
    """Of the line of least squares."""
    middle, mean = sum(times) / len(times), sum(values) / len(values)
    above = sum((time - middle) * (value - mean) for time, value in zip(times, values, strict=True))
    return above / sum((time - middle) ** 2 for time in times)
