"""A wheel takes along the machine code that `make wheel` has made; other builds are not changed."""

import os
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class Carried(BuildHookInterface):
    """TRSIM_CARRIED names the folder of the files, from here."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        folder = os.environ.get("TRSIM_CARRIED")
        if not folder or version != "standard":  # an editable one: from sources
            return
        files = sorted(Path(self.root, folder).glob("*.code"))
        if not files:
            raise FileNotFoundError(f"no machine code in {folder}: run trsim.kernels.carry first")
        build_data["force_include"] |= {str(file): f"trsim/carried/{file.name}" for file in files}
