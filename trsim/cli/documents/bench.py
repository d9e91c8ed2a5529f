"""The document of measurements of work against precision."""

from trsim.analyse import precision
from trsim.analyse.trajectory import Setting
from trsim.cli.documents.common import Document, Number, of
from trsim.statuses import Ended


class Reference(of(precision.Reference, "setting", "run", "rows")):
    """What errors are taken against.

    method     of the run
    tolerance  of that run
    """

    method: str
    tolerance: float


class Measured(of(Setting), of(precision.Point, "setting")):
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
