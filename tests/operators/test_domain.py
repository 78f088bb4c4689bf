"""Domain: an object of one's own makes the pair through one method."""

from scipy.sparse import csr_array

from beltrami.operators.laplacian import laplacian


class Path:
    """A path of three vertices."""

    def make_laplacian(self, weights, mass):
        assert (weights, mass) == ("combinatorial", None)
        return laplacian(csr_array([[0, 1, 0], [1, 0, 1], [0, 1, 0]]))


def test_an_object_with_the_one_method_is_a_domain():
    assert laplacian(Path(), "combinatorial").degrees.tolist() == [1, 2, 1]
