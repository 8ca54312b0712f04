#!/usr/bin/env python3
"""Tests the solids of second_simulator.py against their definitions; exits with code 77 if its packages are not installed."""

import sys
import unittest

try:
    import numpy as np
    from second_simulator import CLASSES, Solid
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

SIZES = {"cylinder": (1.9, 0.5, 0.5), "cube": (0.7, 0.7, 0.7), "sphere": (0.8, 0.8, 0.8)}


def depth_inside(solid, points):
    """Distance to the surface by the shape's definition, above 0 inside."""
    p = points - solid.middle
    if solid.shape == "cube":
        return solid.length / 2 - np.abs(p).max(axis=1)
    if solid.shape == "sphere":
        return solid.radius - np.linalg.norm(p, axis=1)
    return np.minimum(solid.length / 2 - np.abs(p[:, 0]), solid.radius - np.hypot(p[:, 1], p[:, 2]))


class Solids(unittest.TestCase):
    def test_lines_are_blocked_where_one_of_their_points_lies_inside(self):
        for shape in CLASSES:
            g = np.random.default_rng(1)
            solid = Solid(shape, SIZES[shape], 0.1)
            start, end = g.uniform(-2, 2, (4000, 3)), g.uniform(-4, 4, (4000, 3))
            steps = np.linspace(0, 1, 2001)
            deepest = np.max([depth_inside(solid, start + s * (end - start)) for s in steps], axis=0)
            clear = np.abs(deepest) > 0.01  # not decided by the steps' length
            blocked = solid.blocks(start, end) & (np.linalg.norm(end - start, axis=1) > 0)
            # A solid behind the end of a line blocks it too: ends are the sonar's, which lies outside.
            beyond = np.max([depth_inside(solid, start + s * (end - start)) for s in np.linspace(1, 40, 4001)], axis=0)
            clear &= beyond < -0.01
            self.assertGreater(blocked[clear].sum(), 100, shape)
            np.testing.assert_array_equal(blocked[clear], deepest[clear] > 0, shape)

    def test_surfaces_are_where_they_are_defined_and_face_outwards(self):
        for shape in CLASSES:
            solid = Solid(shape, SIZES[shape], 0.25)
            points, normals = solid.surface(np.random.default_rng(2), 5000)
            np.testing.assert_allclose(depth_inside(solid, points), 0, atol=1e-9, err_msg=shape)
            np.testing.assert_allclose(depth_inside(solid, points + 1e-3 * normals), -1e-3, atol=1e-6, err_msg=shape)
            self.assertAlmostEqual(points[:, 2].min(), -0.25 * SIZES[shape][2], delta=0.01)

    def test_points_are_uniform_over_the_surface(self):
        solid = Solid("cylinder", SIZES["cylinder"], 0)
        points, normals = solid.surface(np.random.default_rng(3), 40000)
        caps = 2 * np.pi * 0.25**2
        self.assertAlmostEqual(solid.area(), caps + 2 * np.pi * 0.25 * 1.9)
        self.assertAlmostEqual((np.abs(normals[:, 0]) > 0.5).mean(), caps / solid.area(), delta=0.01)
        self.assertAlmostEqual((points[:, 0] > 0).mean(), 0.5, delta=0.01)


unittest.main(argv=[sys.argv[0], "-v"])
