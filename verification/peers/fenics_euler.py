#!/usr/bin/python3
"""PFHub 1d by FEniCS, as its users write it: mixed P1 elements, implicit Euler, Newton with MUMPS.

Steps grow by a tenth while Newton's method takes four iterations at most, and shrink else.
usage: fenics_euler.py LEVEL T_END FIRST_STEP
"""
import sys

import numpy as np
from dolfin import (Expression, FiniteElement, Function, FunctionSpace, LogLevel, Mesh,
                    MeshEditor, NonlinearProblem, NewtonSolver, TestFunctions, TrialFunction,
                    assemble, derivative, dot, dx, grad, parameters, set_log_level, split,
                    vertex_to_dof_map)

import problem

GROWTH, EASY, MOST = 1.1, 4, 10


def surface_mesh(points, triangles):
    mesh, editor = Mesh(), MeshEditor()
    editor.open(mesh, "triangle", 2, 3)
    editor.init_vertices(len(points))
    editor.init_cells(len(triangles))
    for i, x in enumerate(points):
        editor.add_vertex(i, x)
    for i, corners in enumerate(triangles):
        editor.add_cell(i, np.array(corners, dtype=np.uintp))
    editor.close()
    mesh.init_cell_orientations(Expression(("x[0]", "x[1]", "x[2]"), degree=1))
    return mesh


class Step(NonlinearProblem):
    def __init__(self, residual, jacobian):
        super().__init__()
        self.residual, self.jacobian = residual, jacobian

    def F(self, b, _x):
        assemble(self.residual, tensor=b)

    def J(self, A, _x):
        assemble(self.jacobian, tensor=A)


def main():
    level, t_end, first_step = int(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3])
    set_log_level(LogLevel.ERROR)
    parameters["form_compiler"]["optimize"] = True
    parameters["form_compiler"]["cpp_optimize"] = True
    parameters["form_compiler"]["quadrature_degree"] = 4
    points, triangles = problem.icosphere(level)
    mesh = surface_mesh(points, triangles)
    element = FiniteElement("Lagrange", mesh.ufl_cell(), 1)
    space = FunctionSpace(mesh, element * element)
    u, before = Function(space), Function(space)
    c, mu = split(u)
    c_before, _ = split(before)
    v, w = TestFunctions(space)
    step = Expression("dt", dt=first_step, degree=0)
    residual = (c - c_before) * v * dx + step * problem.MOBILITY * dot(grad(mu), grad(v)) * dx
    residual += (mu - problem.potential(c)) * w * dx - problem.KAPPA * dot(grad(c), grad(w)) * dx
    energy = (problem.energy_density(c) + 0.5 * problem.KAPPA * dot(grad(c), grad(c))) * dx
    equations = Step(residual, derivative(residual, u, TrialFunction(space)))
    newton = NewtonSolver()
    newton.parameters["linear_solver"] = "mumps"
    newton.parameters["relative_tolerance"] = 1e-8
    newton.parameters["absolute_tolerance"] = 1e-11
    newton.parameters["maximum_iterations"] = MOST
    newton.parameters["error_on_nonconvergence"] = False

    values = u.vector().get_local()
    values[vertex_to_dof_map(space)[0::2]] = problem.initial_concentration(mesh.coordinates())
    u.vector().set_local(values)
    before.assign(u)
    t, dt = 0.0, first_step
    for end in problem.TIMES:
        if end > t_end:
            break
        while t < end * (1 - 1e-12):
            step.dt = min(dt, end - t)
            iterations, converged = newton.solve(equations, u.vector())
            if not converged:
                u.assign(before)
                dt = step.dt / 2
                continue
            t += step.dt
            before.assign(u)
            if step.dt == dt:
                dt *= GROWTH if iterations <= EASY else 1 / GROWTH
        problem.report(end, assemble(energy))
    print("nodes", mesh.num_vertices())


main()
