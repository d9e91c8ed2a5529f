import json

import pytest
from jsonschema import Draft202012Validator

from tests import small
from trsim.cli import main
from trsim.cli.published import WORDS, published

SCHEMAS = {word: published(word) for word in WORDS}


def faults(document, command):
    """What is wrong with a document by the schema of a command."""
    return [fault.message for fault in Draft202012Validator(SCHEMAS[command]).iter_errors(document)]


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
        assert faults(document, arguments[0]) == []
        return code, document

    return command
