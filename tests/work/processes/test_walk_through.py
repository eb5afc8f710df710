"""The walk-through of docs/cluster.md is run as it stands there: scheduler and workers with TLS, a study on them."""

import os
import re
import shutil
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest
from children import PATIENCE
from same import assert_same

import study

pytest.importorskip("distributed")
ROOT = Path(__file__).resolve().parents[3]
WALK = (ROOT / "docs" / "cluster.md").read_text(encoding="utf-8")
ENVIRONMENT = os.environ | {
    "PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]]),
    "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tests/shared")]),
    "DASK_DISTRIBUTED__WORKER__DAEMON": "False",
}


@pytest.mark.skipif(not shutil.which("openssl"), reason="openssl makes the certificate")
def test_walk_through_of_the_documentation(tmp_path):
    walk, tunnel, slurm = re.findall(r"```sh\n(.*?)```", WALK, flags=re.DOTALL)
    script = "set -eu\nexport PYTHONPATH\n" + walk + 'echo "at $address"\n'
    with open(tmp_path / "said", "w+") as said:  # scheduler and workers would hold a pipe open if the script fails
        ran = subprocess.Popen(
            ["sh", "-c", script], cwd=tmp_path, env=ENVIRONMENT, stdout=said, stderr=said, start_new_session=True
        )
        try:
            code = ran.wait(PATIENCE)
        finally:
            with suppress(ProcessLookupError):
                os.killpg(ran.pid, signal.SIGKILL)
    said = (tmp_path / "said").read_text()
    assert code == 0, said
    assert (tmp_path / "key.pem").stat().st_mode & 0o077 == 0, "the key is its owner's"
    assert "\nat tls://127.0.0.1:" in said
    assert "results/walk.nc: 600 cases, 600 computed now" in said and "converged: 600" in said
    opened = study.load(tmp_path / "walk.toml", tmp_path / "results")
    here = study.Study(opened.definition, tmp_path / "here")
    here.run()
    assert_same(opened.open(), here.open())
    for script in (tunnel, slurm):
        assert subprocess.run(["sh", "-n"], input=script, text=True, check=False).returncode == 0
