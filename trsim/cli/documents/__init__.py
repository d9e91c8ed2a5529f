"""The documents that `--json` prints, as types; published.py makes JSON Schemas of them.

Nothing here is imported when a command runs.  A number that is not finite is null.  A command
that did not end with 0 may leave out what its document has beyond `Document`.
"""

from trsim.cli.documents.bench import Bench, Measured, Reference
from trsim.cli.documents.certificate import (
    Certificate,
    Certified,
    Curve,
    Level,
    Onset,
    Onsets,
    Parted,
    Quantity,
)
from trsim.cli.documents.checks import (
    Bar,
    Check,
    Checked,
    ContactScale,
    Mesh,
    Mode,
    Moved,
    Projection,
    Release,
    Scales,
    Start,
)
from trsim.cli.documents.common import Document, Error
from trsim.cli.documents.files import (
    Dispersion,
    Export,
    Provenance,
    Recover,
    Report,
    Show,
    Solver,
    Summary,
    Value,
)
from trsim.cli.documents.runs import (
    Contact,
    Ran,
    Results,
    Run,
    RunStatistics,
    Statistics,
)
from trsim.cli.documents.sweeps import Failed, Needed, Status, Sweep
from trsim.cli.documents.words import Channel, ElementPage, Explain, Key, Schema, SectionPage

__all__ = [
    "Bar",
    "Bench",
    "Certificate",
    "Certified",
    "Channel",
    "Check",
    "Checked",
    "Contact",
    "ContactScale",
    "Curve",
    "Dispersion",
    "Document",
    "ElementPage",
    "Error",
    "Explain",
    "Export",
    "Failed",
    "Key",
    "Level",
    "Measured",
    "Mesh",
    "Mode",
    "Moved",
    "Needed",
    "Onset",
    "Onsets",
    "Parted",
    "Projection",
    "Provenance",
    "Quantity",
    "Ran",
    "Recover",
    "Reference",
    "Release",
    "Report",
    "Results",
    "Run",
    "RunStatistics",
    "Scales",
    "Schema",
    "SectionPage",
    "Show",
    "Solver",
    "Start",
    "Statistics",
    "Status",
    "Summary",
    "Sweep",
    "Value",
]
