"""PFHub benchmark 1, variant (d), for programs on fitted meshes: sphere, parameters, initial state.

The initial state is that with the azimuth in [0, 2 pi), which has its seam at the half plane
y = 0, x > 0.
"""
import numpy as np

RADIUS = 100.0
RHO, C_ALPHA, C_BETA = 5.0, 0.3, 0.7
KAPPA, MOBILITY = 2.0, 5.0
TIMES = (1.0, 10.0, 100.0, 1000.0)


def energy_density(c):
    return RHO * (c - C_ALPHA) ** 2 * (C_BETA - c) ** 2


def potential(c):
    return 2 * RHO * (c - C_ALPHA) * (C_BETA - c) * (C_ALPHA + C_BETA - 2 * c)


def potential_slope(c):
    return 2 * RHO * ((C_ALPHA + C_BETA - 2 * c) ** 2 - 2 * (c - C_ALPHA) * (C_BETA - c))


def initial_concentration(points):
    theta = np.arccos(np.clip(points[:, 2] / np.linalg.norm(points, axis=1), -1, 1))
    phi = np.mod(np.arctan2(points[:, 1], points[:, 0]), 2 * np.pi)
    waves = np.cos(8 * theta) * np.cos(15 * phi)
    waves += (np.cos(12 * theta) * np.cos(10 * phi)) ** 2
    waves += np.cos(2.5 * theta - 1.5 * phi) * np.cos(7 * theta - 2 * phi)
    return 0.5 + 0.05 * waves


def icosphere(level):
    """Points and triangles of an icosahedron whose triangles are divided by four `level` times."""
    golden = (1 + 5 ** 0.5) / 2
    signs = [(s, t) for s in (-1, 1) for t in (-1, 1)]
    corners = [np.roll([0, s, t * golden], k) for k in range(3) for s, t in signs]
    points = np.array(corners) / np.sqrt(1 + golden ** 2)
    edge = 2 / np.sqrt(1 + golden ** 2)
    near = np.linalg.norm(points[:, None] - points[None], axis=2) < 1.01 * edge
    triangles = []
    for i in range(12):
        for j in range(i + 1, 12):
            for k in range(j + 1, 12):
                if near[i, j] and near[j, k] and near[i, k]:
                    outward = np.dot(np.cross(points[j], points[k]), points[i]) > 0
                    triangles.append((i, j, k) if outward else (i, k, j))
    triangles = np.array(triangles)
    for _ in range(level):
        points, triangles = divided(points, triangles)
    return RADIUS * points, triangles


def divided(points, triangles):
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]))
    unique, which = np.unique(edges, axis=0, return_inverse=True)
    middles = points[unique].sum(axis=1)
    middles /= np.linalg.norm(middles, axis=1)[:, None]
    between_01, between_12, between_20 = len(points) + which.reshape(3, -1)
    first, second, third = triangles.T
    parts = [(first, between_01, between_20), (second, between_12, between_01),
             (third, between_20, between_12), (between_01, between_12, between_20)]
    return np.concatenate([points, middles]), np.concatenate([np.stack(p, axis=1) for p in parts])


def report(t, energy):
    """What the comparison reads: one line for each time that was reached."""
    print(f"energy {t:g} {energy:.9g}", flush=True)
