# SPDX-License-Identifier: Apache-2.0
"""What a figure is, when it is good enough, and how its line looks."""

import dataclasses
from typing import Callable, Optional, Union


@dataclasses.dataclass(frozen=True)
class Figure:
    """A claim: a number with its bound and the goal beyond it, or, with `expected`, a fact in words.

    Without bound and expectation it is printed for comparison only. `manual` is the command of what one has to look at.
    """

    name: str
    unit: str = ""
    at_most: Optional[float] = None
    below: Optional[float] = None
    at_least: Optional[float] = None
    goal: Optional[float] = None
    expected: str = ""
    manual: str = ""

    def holds(self, value):
        """Whether the value is good enough; a value that is not a number is judged by what it is compared with."""
        if self.at_most is not None:
            return value <= self.at_most
        if self.below is not None:
            return value < self.below
        if self.at_least is not None:
            return value >= self.at_least
        return True

    def bound(self):
        for sign, number in (("<=", self.at_most), ("<", self.below), (">=", self.at_least)):
            if number is not None:
                return f"{sign} {with_unit(number, self.unit)}"
        return self.expected or "-"


@dataclasses.dataclass(frozen=True)
class Fact:
    """The value of a figure in words, with the judgement of who measured it."""

    text: str
    holds: bool


@dataclasses.dataclass(frozen=True)
class Section:
    """Figures that are measured together. `measure(bench)` yields (name, number or Fact) of each."""

    name: str
    figures: list
    measure: Callable


class Skipped(Exception):
    """Cannot be measured here: no data, no root, no package."""


class Failed(Exception):
    """The program, or what it is compared with, did not do its part."""


def with_unit(number: Union[int, float], unit: str):
    return f"{number:.4g} {unit}".rstrip()


def format_line(status, topic, figure, value):
    text = value.text if isinstance(value, Fact) else value if isinstance(value, str) else with_unit(value, figure.unit)
    goal = "-" if figure.goal is None else with_unit(figure.goal, figure.unit)
    return f"{status:<7}  {topic + '/' + figure.name:<60}  {text:<18}  {figure.bound():<18}  {goal}".rstrip()


def measure_section(section, bench):
    """Yields (figure, status, value) of all figures of a section; one that gets no value says why."""
    waiting = {figure.name: figure for figure in section.figures}
    missing = ("short", "not measured")
    try:
        for name, value in section.measure(bench):
            figure = waiting.pop(name)
            good = value.holds if isinstance(value, Fact) else figure.holds(value)
            yield figure, "ok" if good else "short", value
    except Skipped as reason:
        missing = ("skipped", str(reason))
    except (Failed, OSError, KeyError, ValueError) as fault:
        missing = ("short", f"failed: {type(fault).__name__ + ': ' if not isinstance(fault, Failed) else ''}{fault}")
    for figure in waiting.values():
        if figure.manual:
            yield figure, "manual", figure.manual
        else:
            yield figure, *missing
