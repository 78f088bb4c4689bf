"""Grid: regular points of a box or of a torus, in any dimension (section 3.2.4)."""

from __future__ import annotations

from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Floats, as_function
from beltrami._kinds import checked, require_kind
from beltrami.grids import kernels
from beltrami.grids.differences import grid_gradient
from beltrami.grids.eigenvalues import grid_eigenvalues
from beltrami.grids.lattice import kinds, lattice_pair
from beltrami.grids.limit import AveragingLimit, averaging_limit
from beltrami.grids.modes import GridModes, grid_modes
from beltrami.grids.points import Points
from beltrami.grids.values import Values
from beltrami.operators.pair import Laplacian


class Grid(Points):
    r"""n = p₁ ··· p_d points at equal steps, with neighbours along the axes.

    A periodic axis is a circle: its points are :math:`x_i = i h`, and the point after the last is
    the first. The default step 1/p makes it the circle [0, 1), whose end is *not* a point of its
    own (E31). An axis with ends is the interval [0, p h], and its points are the middles of its
    cells, :math:`x_i = (i + \frac12) h`; nothing flows out of it (Neumann).

    ``laplacian(grid)`` makes the pair. Functions have one row for each point, the last axis
    fastest; ``f.reshape(grid.shape)`` gives them the shape that ``dft`` and ``convolve`` take.

    Parameters
    ----------
    shape
        Points along each axis, whole numbers >= 1; one number for one axis.
    periodic
        True or False for all axes, or one for each.
    spacing
        Step h, for all axes or for each, in any unit of length; 1/p if not given.

    Raises
    ------
    DimensionError
        If a size, a flag or a step is not of this kind, or the grid too large for its matrices.
    NonFiniteError
        If a step is NaN or infinite.

    Notes
    -----
    On a circle of two points both neighbours of a point are the other one: one edge, of twice the
    weight. On an axis of one point there are no neighbours. Nothing is computed before it is
    asked for.

    Chapter items: U16, P24, P25.

    Examples
    --------
    >>> from beltrami.operators.laplacian import laplacian
    >>> grid = Grid((8, 9))
    >>> grid
    <Grid: 8 x 9 points, periodic, spacing 0.125 x 0.111111>
    >>> laplacian(grid)
    <Laplacian: 72 vertices, combinatorial weights, degree mass, positive semi-definite>
    """

    def make_laplacian(self, weights: str | None = None, mass: str | None = None) -> Laplacian:
        r"""Return the pair (L, B); ``laplacian(grid, weights, mass)`` calls this.

        ===================  =================================================================
        ``"combinatorial"``  :math:`w = 1` (default)
        ``"distance"``       :math:`w = 1/h_a^2` along axis a: L ≈ -Δ, with the unit mass (U21)
        ``"dirichlet"``      :math:`w = h_1 \cdots h_d / h_a^2`: :math:`\langle Lf, f\rangle
                             \approx \int |\nabla f|^2`, and B⁻¹L ≈ -Δ with the Voronoi mass
        ===================  =================================================================

        The mass is ``"degree"`` (default, B = D), ``"voronoi"`` (default for Dirichlet weights:
        the measure :math:`h_1 \cdots h_d` of the cell of a point; they add to that of the box)
        or ``"unit"``.

        Raises
        ------
        UnknownNameError
            If a name is misspelt.
        MeshError
            For the degree mass of a single point; for steps whose powers leave the floats.

        Notes
        -----
        Cost: O(d n).

        Chapter items: U21, U22, U24, U25, P25, P36.

        Examples
        --------
        >>> Grid(4, spacing=0.5).make_laplacian("distance").stiffness.toarray()[0].tolist()
        [8.0, -4.0, 0.0, -4.0]
        """
        return lattice_pair(self._axes, kinds(weights, mass))

    def gradient(self, scheme: str = "forward") -> csr_array:
        r"""Return the (d n, n) partial derivatives by differences, the first axis on top.

        ``(grid.gradient() @ f).reshape(d, n)``. ``"forward"`` is :math:`(f_{i+1} - f_i)/h`,
        ``"backward"`` :math:`(f_i - f_{i-1})/h`, ``"centered"`` their mean: exact to order 1, 1
        and 2. Beyond an end the value of the end is repeated. Only the centered one is
        antisymmetric (E41). Unit: that of f over length.

        Raises UnknownNameError if there is no such scheme. Cost: O(d n).

        Chapter items: P31, P37.

        Examples
        --------
        >>> (Grid(4).gradient() @ [0.0, 1.0, 4.0, 9.0]).tolist()
        [4.0, 12.0, 20.0, -36.0]
        """
        return grid_gradient(self._axes, scheme)

    def divergence(self, scheme: str = "forward") -> csr_array:
        r"""Return the (n, d n) divergence that goes with ``gradient(scheme)``: :math:`-G^T` (E41).

        So :math:`\langle Gf, v\rangle = -\langle f, \mathrm{div}\,v\rangle`, and minus the
        divergence of the gradient is L of the distance weights, for the forward and the backward
        scheme. Beside forward gradients stand backward differences.

        Raises UnknownNameError if there is no such scheme. Cost: O(d n).

        Chapter items: P31, P37, U23.

        Examples
        --------
        >>> (Grid(4).divergence() @ [0.0, 1.0, 4.0, 9.0]).tolist()
        [-36.0, 4.0, 12.0, 20.0]
        """
        return csr_array(-self.gradient(scheme).T)

    def kernel(self, stencil: ArrayLike) -> Values:
        """Return the kernel, in the shape of the grid, with these values centred at 0 (l. 254).

        What the chapter writes (-1, 2, -1) is ``grid.kernel([-1, 2, -1])``: 2 at index 0, -1 at 1
        and at p - 1. On a small grid values that fall on one point are added.

        Raises DimensionError if the stencil has not d axes of odd size; BeltramiError if the grid
        has ends. Cost: O(n + q) for q values.

        Chapter items: U16, U21, U24, X4.

        Examples
        --------
        >>> Grid(5).kernel([-1, 2, -1]).tolist()
        [2.0, -1.0, 0.0, 0.0, -1.0]
        """
        return kernels.placed(self._axes, stencil)

    def averaging_kernel(self, weights: str = "combinatorial") -> Floats:
        r"""Return the kernel :math:`\tilde w` of D⁻¹W (example 4): 1/2d at each of 2d neighbours.

        The printed :math:`|N| = 2^d` is right for d = 1 and 2 only (E33).

        Raises UnknownNameError; BeltramiError if the grid has ends; MeshError if it is one point.

        Chapter items: X4.

        Examples
        --------
        >>> Grid(4).averaging_kernel().tolist()
        [0.0, 0.5, 0.0, 0.5]
        """
        return kernels.averaging_kernel(self._axes, kinds(weights, None).weights)

    def laplacian_kernel(self, weights: str = "combinatorial") -> Floats:
        """Return the kernel of L: (-1, 2, -1) in one dimension (E47), over h² for distance weights.

        Raises UnknownNameError; BeltramiError if the grid has ends.

        Chapter items: U21, U24.

        Examples
        --------
        >>> Grid((3, 4)).laplacian_kernel().tolist()
        [[4.0, -1.0, 0.0, -1.0], [-1.0, 0.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 0.0]]
        """
        return kernels.laplacian_kernel(self._axes, kinds(weights, None).weights)

    def eigenvalues(self, weights: str | None = None, mass: str | None = None) -> Floats:
        r"""Return the eigenvalues of the pair, in the shape of the grid: ω = 0..p-1 as in ``dft``.

        With combinatorial weights and the unit mass :math:`\lambda_\omega = \sum_a 4
        \sin^2(\pi\omega_a/p_a)`, not :math:`2\pi` as printed (theorems 11 and 12, E69, E70); the
        degree mass divides by 2d. Between two ends p becomes 2p. ``np.sort(..., axis=None)``
        gives the spectral order, which is another one (E71).

        Raises
        ------
        UnknownNameError, MeshError
            As ``make_laplacian``.
        BeltramiError
            For the degree mass in several dimensions with ends: there is no closed form.

        Notes
        -----
        Names and defaults are those of ``make_laplacian``. Cost: O(n).

        Chapter items: T11, T12.

        Examples
        --------
        >>> Grid(4).eigenvalues(mass="unit").round(12).tolist()
        [0.0, 2.0, 4.0, 2.0]
        """
        return grid_eigenvalues(self._axes, kinds(weights, mass))

    def fourier_modes(
        self,
        k: int | None = None,
        weights: str | None = None,
        mass: str | None = None,
        *,
        real: bool = True,
    ) -> GridModes:
        r"""Return the k modes of smallest eigenvalue, orthonormal for the mass (theorems 11, 12).

        Complex, they are :math:`\exp(2i\pi\sum_a k_a\omega_a/p_a)` up to a factor (E70); real,
        products of cosines and sines: another basis of the same eigenspaces. Between two ends
        they are cosines in both.

        Parameters
        ----------
        k
            How many, n if not given. A cut through an eigenspace keeps the lower frequencies.
        weights, mass
            As ``make_laplacian``.
        real
            Whether cosines and sines are wanted, or exponentials.

        Raises
        ------
        UnknownNameError, MeshError, BeltramiError
            As ``eigenvalues``; BeltramiError too if k is not in 1..n.

        Notes
        -----
        Cost: O(n k + n log n).

        Chapter items: T11, T12, P29, P56.

        Examples
        --------
        >>> found = Grid(4).fourier_modes(3, mass="unit")
        >>> found.eigenvalues.round(12).tolist(), found.frequencies.ravel().tolist()
        ([0.0, 2.0, 2.0], [0, 1, 3])
        >>> (found.modes[:, 1] * 2**0.5).round(12).tolist()
        [1.0, 0.0, -1.0, -0.0]
        """
        require_kind("real", real, ("bool",))
        return grid_modes(self._axes, kinds(weights, mass), k, real)

    @checked
    def averaging_limit(
        self, f: ArrayLike, weights: str = "combinatorial", *, lazy: bool = False
    ) -> AveragingLimit:
        r"""Tell where :math:`\tilde W^k f` goes: to the mean or nowhere (theorem 5, E37).

        On a bipartite grid even and odd powers have two limits, the means of the two colours. The
        lazy filter :math:`(\mathrm{Id} + \tilde W)/2` always tends to the mean. Means are weighted
        by the degrees, which matters near ends only.

        Parameters
        ----------
        f
            (n,) or (n, c).
        weights
            As ``make_laplacian``.
        lazy
            Whether the lazy filter is meant.

        Raises
        ------
        UnknownNameError, MeshError
            As ``make_laplacian``.
        DimensionError, NonFiniteError
            If f is not a function on the grid.

        Notes
        -----
        Cost: that of the pair, and O(n c).

        Chapter items: T5.

        Examples
        --------
        >>> Grid(4).averaging_limit([4.0, 0.0, 2.0, 0.0])
        AveragingLimit(even=array([3., 0., 3., 0.]), odd=array([0., 3., 0., 3.]), converges=False)
        """
        pair = self.make_laplacian(weights, "degree")
        return averaging_limit(self._axes, pair, as_function(f, self.n_vertices), lazy)
