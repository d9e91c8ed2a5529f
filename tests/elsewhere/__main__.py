"""python -m tests.elsewhere [pytest's words]: tests of files, processes and commands, bare."""

import os
import subprocess
import sys

from tests.elsewhere import HERE, ROOT

PARTS = ("tests/cli", "tests/sweeps", "tests/store", "tests/kernels", "tests/api")

if __name__ == "__main__":
    words = sys.argv[1:]
    if not any(not word.startswith("-") and os.path.exists(word.split("::")[0]) for word in words):
        words += PARTS
    path = os.pathsep.join([str(HERE), str(ROOT), os.environ.get("PYTHONPATH", "")])
    command = [sys.executable, "-m", "pytest", *words]
    done = subprocess.run(command, cwd=ROOT, env={**os.environ, "PYTHONPATH": path})  # noqa: S603
    sys.exit(done.returncode)
