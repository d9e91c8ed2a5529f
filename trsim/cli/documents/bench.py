"""The document of measurements of work against precision."""

from typing_extensions import TypedDict  # pydantic wants this one before Python 3.12

from trsim.analyse.precision import Point
from trsim.analyse.trajectory import Setting
from trsim.cli.documents.common import Document, Number, of
from trsim.statuses import Ended


class Reference(TypedDict):
    """What errors are taken against.

    method            of the run
    tolerance         of that run
    second_method     of another run, at the same tolerance
    second_failed     why that one did not reach its end, or ""
    uncertainty       error of the second run
    peak_uncertainty  peak error of the second run; null without contacts
    apart             s; from here on the two differ by more than 1 % of a range, and errors are
                      taken over the rows before; null where they never do
    ranges            quantity -> its largest less its smallest value, SI
    still             quantities that do not move, and are left out
    """

    method: str
    tolerance: float
    second_method: str
    second_failed: str
    uncertainty: Number
    peak_uncertainty: Number
    apart: Number
    ranges: dict[str, Number]
    still: list[str]


class Measured(of(Setting), of(Point, "setting")):
    """One method at one setting.

    status  how the runs ended; nothing is measured of one that failed
    """

    status: Ended


class Bench(Document):
    """trsim bench.

    file       as given
    title      of the scenario
    folder     of the figure and the table
    reference  what errors are taken against
    points     methods at their settings, in the order measured; after a signal, those until then
    slopes     method -> slope of log error over log tolerance (or step), resolved errors alone, of
               peak errors where the references part; null of fewer than two
    files      written, in that folder
    """

    file: str
    title: str
    folder: str
    reference: Reference
    points: list[Measured]
    slopes: dict[str, Number]
    files: list[str]
