#!/usr/bin/python3
"""PFHub 1d by PETSc TS: P1 elements on an icosphere, c and mu as a DAE, Rosenbrock-W steps, MUMPS.

usage: petsc_ts.py LEVEL T_END RTOL [options of PETSc]
"""
import sys

import numpy as np
import petsc4py
import scipy.sparse as sparse
import scipy.sparse.linalg

import problem

petsc4py.init([sys.argv[0]] + sys.argv[4:])
from petsc4py import PETSc  # noqa: E402  (after init)

# Six points, degree four.
A, B = 0.445948490915965, 0.091576213509771
POINTS = np.array([[A, A, 1 - 2 * A], [A, 1 - 2 * A, A], [1 - 2 * A, A, A],
                   [B, B, 1 - 2 * B], [B, 1 - 2 * B, B], [1 - 2 * B, B, B]])
WEIGHTS = np.array([0.223381589678011] * 3 + [0.109951743655322] * 3)


class SurfaceElements:
    """P1 elements on triangles; matrices share one pattern."""

    def __init__(self, points, triangles):
        self.triangles = triangles
        self.size = len(points)
        x = points[triangles]
        normal = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
        twice = np.linalg.norm(normal, axis=1)
        self.area = twice / 2
        opposite = np.stack([x[:, 2] - x[:, 1], x[:, 0] - x[:, 2], x[:, 1] - x[:, 0]], axis=1)
        gradient = np.cross((normal / twice[:, None])[:, None], opposite) / twice[:, None, None]
        self.rows = np.repeat(triangles, 3, axis=1).ravel()
        self.columns = np.tile(triangles, (1, 3)).ravel()
        self.products = np.einsum("q,qi,qj->qij", WEIGHTS, POINTS, POINTS)
        self.mass = self.matrix(self.area[:, None, None] * self.products.sum(axis=0))
        self.stiffness = self.matrix(
            self.area[:, None, None] * np.einsum("tid,tjd->tij", gradient, gradient))

    def matrix(self, local):
        return sparse.csr_matrix((local.ravel(), (self.rows, self.columns)),
                                 shape=(self.size, self.size))

    def at_points(self, c):
        return c[self.triangles] @ POINTS.T

    def load(self, density):
        local = self.area[:, None] * ((WEIGHTS * density) @ POINTS)
        return np.bincount(self.triangles.ravel(), weights=local.ravel(), minlength=self.size)

    def weighted_mass(self, density):
        return self.matrix(self.area[:, None, None] * np.einsum("tq,qij->tij", density, self.products))

    def energy(self, c):
        bulk = np.sum(self.area * (problem.energy_density(self.at_points(c)) @ WEIGHTS))
        return bulk + 0.5 * problem.KAPPA * c @ (self.stiffness @ c)


class CahnHilliard:
    """F(t, u, u') = (M c' + D K mu, M mu - f'(c) - kappa K c) and its Jacobian."""

    def __init__(self, elements):
        self.fem = elements
        self.pattern = self.blocks(1.0, sparse.csr_matrix(elements.mass, copy=True))

    def halves(self, u):
        values = u.getArray(readonly=True)
        return values[:self.fem.size], values[self.fem.size:]

    def residual(self, _ts, _t, u, rate, result):
        (c, mu), (c_rate, _) = self.halves(u), self.halves(rate)
        fem = self.fem
        first = fem.mass @ c_rate + problem.MOBILITY * (fem.stiffness @ mu)
        second = fem.mass @ mu - fem.load(problem.potential(fem.at_points(c)))
        second -= problem.KAPPA * (fem.stiffness @ c)
        result.setArray(np.concatenate([first, second]))

    def blocks(self, shift, curvature):
        fem = self.fem
        whole = sparse.bmat([[shift * fem.mass, problem.MOBILITY * fem.stiffness],
                             [-curvature - problem.KAPPA * fem.stiffness, fem.mass]], format="csr")
        whole.sort_indices()
        return whole

    def jacobian(self, _ts, _t, u, _rate, shift, _matrix, preconditioner):
        c, _ = self.halves(u)
        slope = self.fem.weighted_mass(problem.potential_slope(self.fem.at_points(c)))
        whole = self.blocks(shift, slope)
        preconditioner.setValuesCSR(whole.indptr, whole.indices, whole.data)
        preconditioner.assemble()
        return PETSc.Mat.Structure.SAME_NONZERO_PATTERN


def main():
    level, t_end, rtol = int(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3])
    points, triangles = problem.icosphere(level)
    fem = SurfaceElements(points, triangles)
    equations = CahnHilliard(fem)
    size = 2 * fem.size
    matrix = PETSc.Mat().createAIJ(
        size=(size, size), csr=(equations.pattern.indptr, equations.pattern.indices,
                                equations.pattern.data))
    c = problem.initial_concentration(points)
    right = fem.load(problem.potential(fem.at_points(c))) + problem.KAPPA * (fem.stiffness @ c)
    mu, _ = scipy.sparse.linalg.cg(fem.mass, right, tol=1e-12)
    state = PETSc.Vec().createSeq(size)
    state.setArray(np.concatenate([c, mu]))

    ts = PETSc.TS().create()
    ts.setProblemType(PETSc.TS.ProblemType.NONLINEAR)
    ts.setEquationType(PETSc.TS.EquationType.DAE_IMPLICIT_INDEX1)
    ts.setIFunction(equations.residual, state.duplicate())
    ts.setIJacobian(equations.jacobian, matrix, matrix)
    ts.setType("rosw")
    ts.setTimeStep(1e-2)
    ts.setMaxSteps(200000)
    ts.setExactFinalTime(PETSc.TS.ExactFinalTime.MATCHSTEP)
    # Errors of mu do not count, as in the other programs.
    absolute, relative = state.duplicate(), state.duplicate()
    absolute.setArray(np.repeat([0.5 * rtol, 1e10], fem.size))
    relative.setArray(np.repeat([rtol, 0], fem.size))
    ts.setTolerances(rtol=relative, atol=absolute)
    solver = ts.getSNES().getKSP()
    solver.setType("preonly")
    solver.getPC().setType("lu")
    solver.getPC().setFactorSolverType("mumps")
    ts.setFromOptions()
    for t in problem.TIMES:
        if t > t_end:
            break
        ts.setMaxTime(t)
        ts.solve(state)
        problem.report(t, fem.energy(state.getArray()[:fem.size]))
    print("nodes", fem.size)


main()
