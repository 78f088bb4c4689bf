"""The command in this process, and a mesh file to run it on."""

from __future__ import annotations

import pytest
from typer.testing import CliRunner

from beltrami.cli.app import app
from beltrami.io.registry import write_mesh
from beltrami.mesh.shapes import icosphere


@pytest.fixture
def beltrami():
    """Run the command with these arguments; give its result."""

    def run(*arguments):
        return CliRunner(env={"COLUMNS": "200"}).invoke(app, [str(word) for word in arguments])

    return run


@pytest.fixture
def sphere(tmp_path):
    path = tmp_path / "a sphere é.ply"
    write_mesh(path, icosphere(2))
    return path


@pytest.fixture
def stray(tmp_path):
    """Make a mesh with one vertex in no face, and one face without area."""
    path = tmp_path / "stray.off"
    path.write_text("OFF\n6 2 0\n0 0 0\n1 0 0\n0 1 0\n5 5 5\n2 0 0\n3 0 0\n3 0 1 2\n3 1 4 5\n")
    return path
