"""The documents that `--json` prints, as types; published.py makes JSON Schemas of them.

Each command has one, of its name; what a part of it repeats of a dataclass is made of that one.
Nothing here is imported when a command runs.  A number that is not finite is null.  A command
that did not end with 0 may leave out what its document has beyond `Document`.
"""

from trsim.cli.documents.bench import Bench as Bench
from trsim.cli.documents.checks import Check as Check
from trsim.cli.documents.common import Document as Document
from trsim.cli.documents.files import Export as Export
from trsim.cli.documents.files import Recover as Recover
from trsim.cli.documents.files import Report as Report
from trsim.cli.documents.files import Show as Show
from trsim.cli.documents.runs import Run as Run
from trsim.cli.documents.runs import Statics as Statics
from trsim.cli.documents.sweeps import Merge as Merge
from trsim.cli.documents.sweeps import Status as Status
from trsim.cli.documents.sweeps import Sweep as Sweep
from trsim.cli.documents.words import Explain as Explain
from trsim.cli.documents.words import Init as Init
from trsim.cli.documents.words import Schema as Schema
