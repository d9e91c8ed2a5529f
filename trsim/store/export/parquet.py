"""Parquet: a column for each channel under its own name, the unit in the metadata of its field."""

from typing import IO

from trsim.errors import UsageError
from trsim.store.export.columns import Columns

ROWS = 1 << 16  # of a group


def write(columns: Columns, out: IO[bytes]) -> None:
    """Raises UsageError where pyarrow is not installed."""
    try:
        import pyarrow
        from pyarrow.parquet import ParquetWriter
    except ImportError:
        hint = '`pip install "trsim[parquet]"` installs it; .csv, .xlsx and .mat need nothing.'
        raise UsageError("Parquet needs the package pyarrow, which is not there", hint) from None
    attributes = columns.run.attributes
    about = {
        "trsim.title": str(attributes["title"]),
        "trsim.status": str(attributes["status"]),
        "trsim.content_sha256": str(attributes.get("content_sha256", "")),
    }
    fields = [
        pyarrow.field(name, pyarrow.float64(), nullable=False, metadata={"units": unit})
        for name, unit in zip(columns.names, columns.units, strict=True)
    ]
    schema = pyarrow.schema(fields, metadata=about)
    with ParquetWriter(out, schema) as file:
        for block in columns.blocks(ROWS):
            arrays = [pyarrow.array(column.copy()) for column in block.T]
            file.write_table(pyarrow.Table.from_arrays(arrays, schema=schema))
