"""Meshes and results in a bucket: a server of S3 on this machine, asked by processes of workers.

Skipped where moto or s3fs are not installed; `make test-neighbours` installs them.
"""

import io
import json

import fsspec
import numpy as np
import pyarrow.parquet
import pytest

import beltrami as bt
from beltrami.io.registry import write_mesh
from beltrami.mesh.shapes import torus

server = pytest.importorskip("moto.server", reason="make test-neighbours installs moto and s3fs")
s3fs = pytest.importorskip("s3fs", reason="make test-neighbours installs moto and s3fs")


@pytest.fixture(scope="module")
def files():
    """Serve S3, and return its file system; whoever asks for S3 now is sent there."""
    serving = server.ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    serving.start()
    host, port = serving.get_host_and_port()
    with pytest.MonkeyPatch.context() as environment:
        for name, value in {
            "AWS_ENDPOINT_URL": f"http://{host}:{port}",
            "AWS_ACCESS_KEY_ID": "nobody",
            "AWS_SECRET_ACCESS_KEY": "nothing",
            "AWS_DEFAULT_REGION": "us-east-1",
        }.items():
            environment.setenv(name, value)
        yield s3fs.S3FileSystem()
    serving.stop()


@pytest.fixture
def bucket(files, meshes):
    """Return the name of a new bucket that has the meshes below ``in``."""
    name = f"bucket-{len(files.ls(''))}"
    files.mkdir(name)
    for path in meshes.iterdir():
        files.put_file(str(path), f"{name}/in/{path.name}")
    return name


@pytest.mark.parametrize("workers", [0, 2])
def test_from_a_bucket_into_a_bucket(files, bucket, workers):
    given, out = f"s3://{bucket}/in/*.ply", f"s3://{bucket}/out"
    state = bt.run_batch(given, "spectrum k=5", out, workers=workers).state
    assert (state.done, state.failed) == (3, 1)
    with files.open(f"{out}/results.parquet") as file:
        rows = {row["source"]: row for row in pyarrow.parquet.read_table(file).to_pylist()}
    assert set(rows) == {f"s3://{bucket}/in/{name}.ply" for name in ("0", "1", "2", "bad")}
    bad = rows.pop(f"s3://{bucket}/in/bad.ply")
    assert (bad["outcome"], bad["error_kind"]) == ("failed", "FileFormatError")
    for row in rows.values():
        basis = np.load(io.BytesIO(files.cat_file(f"{out}/{row['spectrum.file']}")))
        assert np.array_equal(basis["eigenvalues"], row["spectrum.eigenvalues"])
    head = json.loads(files.cat_file(f"{out}/manifest.jsonl").splitlines()[0])
    assert (head["done"], head["failed"], head["complete"]) == (3, 1, True)


def test_a_second_run_does_what_is_new(files, bucket, tmp_path):
    given, out = f"s3://{bucket}/in/*.ply", f"s3://{bucket}/out"
    bt.run_batch(given, "diagnose", out, workers=0)
    before = {name: files.info(name)["LastModified"] for name in files.find(f"{out}/work")}
    write_mesh(tmp_path / "3.ply", torus(20, 7))
    fsspec.filesystem("s3", skip_instance_cache=True).put_file(  # as somebody else would
        str(tmp_path / "3.ply"), f"{bucket}/in/3.ply"
    )
    state = bt.run_batch(given, "diagnose", out, workers=0).state
    assert (state.done, state.failed, state.reused) == (4, 1, 4)
    files.invalidate_cache()
    after = {name: files.info(name)["LastModified"] for name in files.find(f"{out}/work")}
    assert before.items() <= after.items()
