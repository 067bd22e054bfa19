"""Run command lines one after the other in this process and folder, as a shell would.

Standard input is a JSON list of lines, standard output a JSON list of outcomes. Knows
quotes, patterns, ``> FILE``, ``mkdir -p FOLDER``, ``cd FOLDER`` and ``| jq .KEY``,
which checks for the key. The package must come from the folder UPLIFT_FROM.
"""

import glob
import json
import os
import re
import shlex
import sys
import time
from pathlib import Path


def main() -> None:
    """Run the lines."""
    import uplift_cli.main
    from click.testing import CliRunner

    import uplift

    for module in (uplift, uplift_cli):
        assert str(module.__file__).startswith(os.environ["UPLIFT_FROM"]), (
            module.__file__
        )
    outcomes = []
    for line in json.load(sys.stdin):
        begin = time.process_time()
        words, target, key = parse(line)
        if words[0] == "mkdir":
            Path(words[-1]).mkdir(exist_ok=True)
            continue
        if words[0] == "cd":
            os.chdir(words[-1])
            continue
        result = CliRunner().invoke(uplift_cli.main.main, words[1:], prog_name="uplift")
        if target is not None:
            Path(target).write_text(result.stdout, encoding="utf-8")
        code = result.exit_code or int(
            key is not None and key not in json.loads(result.stdout)
        )
        seconds = time.process_time() - begin
        print(f"{seconds:6.1f} s  {code}  {line}", file=sys.stderr, flush=True)
        outcomes.append(
            {
                "line": line,
                "code": code,
                "stdout": result.stdout,
                "stderr": result.stderr,
            }
        )
    json.dump(outcomes, sys.stdout)


def parse(line: str) -> tuple[list[str], str | None, str | None]:
    """Return the words of a command, the file that its output goes to, and the key that
    is read from it.
    """
    line, _, pipe = line.partition(" | jq .")
    line, _, target = line.partition(" > ")
    words = []
    for quoted in re.findall(r"(?:[^\s\"']|\"[^\"]*\"|'[^']*')+", line):
        (word,) = shlex.split(quoted)
        matches = (
            sorted(glob.glob(word)) if glob.has_magic(word) and word == quoted else []
        )
        words += matches or [word]
    return words, target.strip() or None, pipe.strip() or None


if __name__ == "__main__":
    main()
