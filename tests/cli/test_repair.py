import json

from beltrami.io.registry import read_mesh


def test_only_what_is_asked_for_is_done(beltrami, stray, tmp_path):
    output = tmp_path / "out.off"
    done = beltrami("repair", stray, "-o", output, "--remove-degenerate-faces")
    assert done.exit_code == 0
    assert (read_mesh(output).n_vertices, read_mesh(output).n_faces) == (6, 1)
    assert "unreferenced" not in done.stdout


def test_all(beltrami, stray, tmp_path):
    done = beltrami("repair", stray, "-o", tmp_path / "out.off", "--all", "--json")
    told = json.loads(done.stdout)
    assert told["vertex_map"] == [0, 1, 2, -1, -1, -1]
    assert told["face_map"] == [0, -1]
    assert len(told["done"]) == 2


def test_all_keeps_every_component(beltrami, tmp_path):
    path, output = tmp_path / "two.off", tmp_path / "out.off"
    corners = "0 0 0\n1 0 0\n0 1 0\n0 0 9\n1 0 9\n0 1 9\n"
    path.write_text(f"OFF\n6 2 0\n{corners}3 0 1 2\n3 3 4 5\n")
    assert "nothing to repair" in beltrami("repair", path, "-o", output, "--all").stdout
    assert read_mesh(output).n_faces == 2
    beltrami("repair", path, "-o", output, "--keep-largest-component")
    assert read_mesh(output).n_faces == 1


def test_nothing_asked_is_a_usage_error(beltrami, stray, tmp_path):
    done = beltrami("repair", stray, "-o", tmp_path / "out.off")
    assert done.exit_code == 2
    assert "say what to repair" in done.stderr
    assert not (tmp_path / "out.off").exists()
