import numpy as np

from beltrami.mesh.shapes.lattice import lattice_faces


def test_square_by_square():
    faces = lattice_faces(2, 2).reshape(2, 2, 6)
    assert faces[1, 0].tolist() == [3, 4, 7, 3, 7, 6]


def test_alternating_flips_odd_squares_only():
    plain = lattice_faces(3, 4).reshape(3, 4, 2, 3)
    mixed = lattice_faces(3, 4, alternating=True).reshape(3, 4, 2, 3)
    for r in range(3):
        for c in range(4):
            assert np.array_equal(plain[r, c], mixed[r, c]) == ((r + c) % 2 == 0)
            assert set(plain[r, c].ravel()) == set(mixed[r, c].ravel())


def test_rings_wrap_to_the_first_row_and_column():
    faces = lattice_faces(3, 4, ring=(True, True))
    assert faces.max() == 11
    assert faces[-2:].tolist() == [[11, 8, 0], [11, 0, 3]]
