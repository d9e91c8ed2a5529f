import json

import pytest

from tests import small
from trsim.cli import main


@pytest.fixture
def scenario(tmp_path, monkeypatch):
    """A scenario file in the current folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("TRSIM_DEBUG", raising=False)
    (tmp_path / "crank.yaml").write_text(small.SLIDER_CRANK)
    return tmp_path / "crank.yaml"


@pytest.fixture
def trsim(capsys):
    """Runs a command line; exit code, stdout and stderr."""

    def command(*arguments):
        with pytest.raises(SystemExit) as ended:
            main(list(map(str, arguments)))
        captured = capsys.readouterr()
        assert "Traceback" not in captured.err + captured.out
        return ended.value.code, captured.out, captured.err

    return command


@pytest.fixture
def answer(trsim):
    """Runs a command line with --json; exit code and document."""

    def command(*arguments):
        code, out, _ = trsim(*arguments, "--json")
        document = json.loads(out)
        assert document["exit_code"] == code
        assert document["command"] == arguments[0]
        return code, document

    return command
