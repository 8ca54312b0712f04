#!/usr/bin/env python3
"""Trains on chips of a plan and tests on pictures of a second ping simulator, whose sizes and display the plan gives.

    examples/recognize/second_simulator.py GENERATE_DATASET [--out FOLDER] [--seeds N]

The simulator shares no code with the library or with examples/ping_simulator. Each look is the coherent sum of point
scatterers on the bottom and on one target; lines to the sonar intersect targets in closed form and the relief on a grid.
Writes the simulator's pictures and the generator's to FOLDER (out/second), and prints the balanced accuracy of a linear
support vector machine on histograms of gradients of whole chips. Needs numpy, scikit-image and scikit-learn.
"""

import argparse
import csv
import pathlib
import shutil
import subprocess
import warnings

import numpy as np
from skimage.feature import hog
from skimage.io import imread, imsave
from skimage.transform import resize
from sklearn.exceptions import ConvergenceWarning
from sklearn.metrics import balanced_accuracy_score, confusion_matrix
from sklearn.model_selection import GridSearchCV
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import LinearSVC

CLASSES = ("cylinder", "cube", "sphere")
SIZE, PIXEL, WAVELENGTH = 128, 0.05, 1500 / 600e3  # pixels a side, metres, metres
EXTENT = SIZE * PIXEL
BORDER = 0.3  # metres around the picture whose scatterers leak into it

# Ranges, uniform, of the values that a plan gives besides the contents of a chip.
ALTITUDE, DISTANCE = (5, 9), (2.0, 3.8)  # metres; ground range over altitude
ALONG, DISPLAY_RANGE = (0.05, 0.09), (30, 40)  # resolution along the track, metres; decibels from black to white
BOTTOMS = ("sand", "sand", "sand", "ripples")
BOTTOM = 0.5  # approximate intensity of the generator's bottoms


def sampled_size(g, shape):
    """Length, width and height, metres."""
    if shape == "cylinder":
        diameter = g.uniform(0.4, 0.55)
        return g.uniform(1.5, 2.2), diameter, diameter
    return (g.uniform(0.6, 0.8),) * 3 if shape == "cube" else (g.uniform(0.6, 0.9),) * 3


class Solid:
    """A cylinder along x, a cube or a sphere, whose lowest point lies at `bottom`; z is up."""

    def __init__(self, shape, size, burial):
        self.shape, self.length, self.radius = shape, size[0], size[2] / 2
        self.bottom = -burial * size[2]
        self.middle = np.array([0, 0, self.bottom + self.radius])

    def area(self):
        r, length = self.radius, self.length
        return {"cube": 6 * length**2, "sphere": 4 * np.pi * r**2, "cylinder": 2 * np.pi * r * (r + length)}[self.shape]

    def surface(self, g, count):
        """Points and outward normals, uniform over the surface."""
        if self.shape == "sphere":
            normal = g.normal(size=(count, 3))
            normal /= np.linalg.norm(normal, axis=1)[:, None]
            return normal * self.radius + self.middle, normal
        if self.shape == "cube":
            axis, side = g.integers(0, 3, count), g.choice([-1.0, 1.0], count)
            point, normal = g.uniform(-0.5, 0.5, (count, 3)), np.zeros((count, 3))
            point[np.arange(count), axis], normal[np.arange(count), axis] = side / 2, side
            return point * self.length + self.middle, normal
        r, length = self.radius, self.length
        is_cap = g.uniform(size=count) < r / (r + length)
        side, angle = g.choice([-1.0, 1.0], count), g.uniform(0, 2 * np.pi, count)
        x = np.where(is_cap, side * length / 2, g.uniform(-length / 2, length / 2, count))
        radius = np.where(is_cap, r * np.sqrt(g.uniform(size=count)), r)
        round_normal = np.c_[0 * x, np.cos(angle), np.sin(angle)]
        cap_normal = np.c_[side, 0 * x, 0 * x]
        point = np.c_[x, radius * np.cos(angle), radius * np.sin(angle)] + self.middle
        return point, np.where(is_cap[:, None], cap_normal, round_normal)

    def blocks(self, start, end):
        """Whether the line from each start to its end meets the solid."""
        enter, leave = np.zeros(len(start)), np.full(len(start), np.inf)
        start, way = start - self.middle, end - start

        def clip(first, last):
            nonlocal enter, leave
            enter, leave = np.maximum(enter, np.minimum(first, last)), np.minimum(leave, np.maximum(first, last))

        def clip_slab(axis, half):
            along = np.where(np.abs(way[:, axis]) < 1e-12, 1e-12, way[:, axis])
            clip((-half - start[:, axis]) / along, (half - start[:, axis]) / along)

        def clip_round(axes):
            p, d = start[:, axes], way[:, axes]
            a, b, c = (d * d).sum(1), (p * d).sum(1), (p * p).sum(1) - self.radius**2
            root = np.sqrt(np.maximum(b * b - a * c, 0))
            clip((-b - root) / a, (-b + root) / a)  # a line that misses gets an empty interval

        if self.shape == "cube":
            for axis in range(3):
                clip_slab(axis, self.length / 2)
        elif self.shape == "sphere":
            clip_round([0, 1, 2])
        else:
            clip_slab(0, self.length / 2)
            clip_round([1, 2])
        return leave > enter


def relief(g, x, y, bottom):
    """Heights of a gently undulating bottom, with ripples if `bottom` is "ripples", metres."""
    rms, correlation = g.uniform(0.005, 0.03), g.uniform(0.6, 3)
    z = np.zeros_like(x)
    for _ in range(24):
        number, heading = 2 * np.pi / (correlation * np.exp(g.normal(0, 0.4))), g.uniform(0, 2 * np.pi)
        phase = number * (x * np.cos(heading) + y * np.sin(heading)) + g.uniform(0, 2 * np.pi)
        z += np.sqrt(2 / 24) * rms * np.cos(phase)
    if bottom == "ripples":
        length, steepness, heading = g.uniform(0.2, 0.6), g.uniform(0.04, 0.07), g.uniform(0, np.pi)
        bend = np.zeros_like(x)
        for _ in range(6):
            turn, number = g.uniform(0, 2 * np.pi), 2 * np.pi / g.uniform(2, 4)
            bend += 0.5 * np.cos(number * (x * np.cos(turn) + y * np.sin(turn)) + g.uniform(0, 2 * np.pi))
        crest = 2 * np.pi / length * (x * np.cos(heading) + y * np.sin(heading)) + bend
        z += length * steepness / 2 * np.cos(crest)
    return z


def picture(shape, seed):
    """One chip of 8 bits, range to the right, and its white over the median intensity."""
    g = np.random.default_rng(seed)
    altitude = g.uniform(*ALTITUDE)
    at = g.uniform(*DISTANCE) * altitude  # ground range of the target
    solid = Solid(shape, sampled_size(g, shape), g.choice([0, 0, g.uniform(0, 0.1)]))
    heading, bottom = g.uniform(0, 2 * np.pi), g.choice(BOTTOMS)
    across, along = g.uniform(0.04, 0.06), g.uniform(*ALONG)  # half-power widths, metres
    looks, noise = int(g.integers(4, 8)), 10 ** (-g.uniform(20, 35) / 10)
    strength, shine = 10 ** (g.uniform(3, 10) / 20), g.uniform(20, 60)  # of the target; exponent of its highlight

    first = np.hypot(at, altitude) - EXTENT / 3
    near, far = (np.sqrt(max(r * r - altitude**2, 0.01)) for r in (first - BORDER, first + EXTENT + BORDER))
    low, high = -EXTENT / 2 - BORDER, EXTENT / 2 + BORDER
    # The bottom on a grid of the sonar's rays, from some metres in front of the picture, whose crests may shade it.
    step_x, step_y = 0.025, 0.05
    grid_x, grid_y = np.arange(max(0.02, near - 3), far, step_x), np.arange(low, high, step_y)
    z = relief(g, *np.meshgrid(grid_x - at, grid_y), bottom)
    z -= z[np.abs(grid_y).argmin(), np.abs(grid_x - at).argmin()]
    slope_y, slope_x = np.gradient(z, step_y, step_x)
    rise = (z - altitude) / grid_x
    is_lit = rise >= np.maximum.accumulate(rise, axis=1) - 1e-4

    def cell(x, y):
        column = np.clip(((x - grid_x[0]) / step_x).astype(int), 0, len(grid_x) - 1)
        return np.clip(((y - low) / step_y).astype(int), 0, len(grid_y) - 1), column

    # Amplitudes are summed on half pixels and blurred by pulse and beam.
    fine = PIXEL / 2
    count = round((EXTENT + 2 * BORDER) / fine)
    frequency = np.fft.fftfreq(count, fine)
    blur = [np.exp(-2 * (np.pi * width / (2 * np.sqrt(np.log(2))) * frequency) ** 2) for width in (along, across)]
    density = 6 / (across * along)  # scatterers a square metre
    turn = np.array([[np.cos(heading), -np.sin(heading), 0], [np.sin(heading), np.cos(heading), 0], [0, 0, 1.0]])
    intensity, floor = np.zeros((SIZE, SIZE)), None
    for _ in range(looks):
        # The bottom: Lambert's law, where neither a crest nor the target blocks the path.
        n = int(density * (far - near) * (high - low) / 2)
        x, y = g.uniform(near, far, n), g.uniform(low, high, n)
        here = cell(x, y)
        stretch = np.sqrt(1 + slope_x[here] ** 2 + slope_y[here] ** 2)
        ranges = np.hypot(x, altitude - z[here])
        cosine = np.maximum((x * slope_x[here] + altitude - z[here]) / ranges / stretch, 0)
        shaded = solid.blocks(np.c_[x - at, y, z[here]] @ turn, np.c_[np.full(n, -at), y, np.full(n, altitude)] @ turn)
        amplitude = cosine * np.sqrt(2 * stretch / density) * (is_lit[here] & ~shaded)
        # The target: diffuse, with a highlight.
        m = max(2000, int(density * solid.area()))
        point, normal = (v @ turn.T for v in solid.surface(g, m))
        to_sonar = np.c_[-at - point[:, 0], np.zeros(m), altitude - point[:, 2]]
        distance = np.linalg.norm(to_sonar, axis=1)
        facing = np.maximum((normal * to_sonar).sum(1) / distance, 0)
        stands_out = point[:, 2] > z[cell(point[:, 0] + at, point[:, 1])]
        grazing = altitude / np.hypot(at, altitude)
        echo = strength * np.sqrt(solid.area() / m) * grazing * (facing + 2.5 * facing**shine) * stands_out

        ranges, y = np.r_[ranges, distance], np.r_[y, point[:, 1]]
        total = np.r_[amplitude, echo] * (g.normal(size=n + m) + 1j * g.normal(size=n + m))
        total *= np.exp(4j * np.pi * ranges / WAVELENGTH)
        column, row = np.floor((ranges - first + BORDER) / fine), np.floor((y - low) / fine)
        inside = (column >= 0) & (column < count) & (row >= 0) & (row < count)
        place = (row * count + column)[inside].astype(int)
        summed = np.bincount(place, total.real[inside], count**2) + 1j * np.bincount(place, total.imag[inside], count**2)
        field = np.fft.ifft2(np.fft.fft2(summed.reshape(count, count)) * blur[0][:, None] * blur[1])
        skip = round(BORDER / fine)
        field = field[skip : skip + 2 * SIZE : 2, skip : skip + 2 * SIZE : 2]
        if floor is None:
            floor = np.sqrt(np.mean(np.abs(field) ** 2) * noise / 2)
        intensity += np.abs(field + floor * (g.normal(size=field.shape) + 1j * g.normal(size=field.shape))) ** 2
    white = np.percentile(intensity, g.uniform(99.5, 99.9))
    decibels = 10 * np.log10(intensity / white)
    gray = np.clip(255 * (1 + decibels / g.uniform(*DISPLAY_RANGE)), 0, 255)
    return gray.round().astype(np.uint8), white / np.median(intensity)


def draw(folder, seed, counts):
    """A set of the simulator's pictures. @returns files, classes, and whites over medians"""
    folder.mkdir(parents=True, exist_ok=True)
    files, names, whites = [], [], []
    for shape, count in zip(CLASSES, counts):
        for _ in range(count):
            gray, white = picture(shape, seed * 100000 + len(files))
            files.append(folder / f"{len(files):04}.png")
            imsave(files[-1], gray, check_contrast=False)
            names.append(shape)
            whites.append(white)
    return files, names, whites


def write_plan(path, seed, count, whites, knows_looks):
    """Writes a line for each chip of the generator, with the values that are known beforehand in a search."""
    g = np.random.default_rng(seed)
    with open(path, "w", newline="", encoding="utf-8") as file:
        table = None
        for shape in CLASSES:
            for i in range(count):
                altitude, distance = g.uniform(*ALTITUDE), g.uniform(*DISTANCE)
                slant_range = altitude * np.hypot(distance, 1)
                row = {"id": f"{shape}{i}", "shape": shape}
                row |= dict(zip(("length", "width", "height"), sampled_size(g, shape)))
                row |= {"seabed": g.choice(BOTTOMS), "altitude_m": altitude, "chip_m": EXTENT, "track_m": EXTENT}
                row |= {"first_range_m": slant_range - EXTENT / 3, "t1_across": 1 / 3, "t1_along": 0.5}
                row |= {"beam_rad": g.uniform(*ALONG) / slant_range, "display": "decibels"}
                row |= {"display_range_db": g.uniform(*DISPLAY_RANGE), "white": BOTTOM * g.choice(whites)}
                row |= {"turn": 0, "enlarged": 0, "ground_range": "false", "targets": 1}
                row |= {"has_clutter": "false", "has_debris": "false", "t1_damage": 0}
                if knows_looks:
                    row["looks"] = g.integers(4, 8)
                if table is None:
                    table = csv.DictWriter(file, row)
                    table.writeheader()
                table.writerow(row)


def generated(generator, folder, seed, whites, knows_looks):
    """A set that the generator makes by a plan. @returns files and classes"""
    plan = folder.with_suffix(".csv")
    write_plan(plan, seed, 130, whites, knows_looks)
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([generator, "--out", folder, "--plan", plan, "--seed", str(seed)], check=True,
                   stdout=subprocess.DEVNULL)
    with open(folder / "manifest.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return [folder / row["file"] for row in rows], [row["class"] for row in rows]


def features(files):
    """Histograms of gradients of whole chips, at half size."""
    chips = [resize(imread(file) / 255.0, (64, 64), anti_aliasing=True) for file in files]
    return np.array([hog(c, orientations=9, pixels_per_cell=(8, 8), cells_per_block=(2, 2)) for c in chips])


def train_and_test(sample, test):
    """Balanced accuracy on the test set; the penalty is chosen on the training pictures alone. @returns it, and a matrix"""
    machine = make_pipeline(StandardScaler(), LinearSVC(class_weight="balanced", max_iter=4000))
    penalties = {"linearsvc__C": [1e-5, 1e-4, 1e-3, 1e-2, 1e-1]}
    search = GridSearchCV(machine, penalties, cv=5, scoring="balanced_accuracy")
    search.fit(*sample)
    named = search.predict(test[0])
    return balanced_accuracy_score(test[1], named), confusion_matrix(test[1], named, labels=CLASSES).tolist()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("generator", help="the program generate_dataset")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/second"), help="folder (out/second)")
    parser.add_argument("--seeds", type=int, default=3, help="sets of each kind (3)")
    given = parser.parse_args()
    warnings.simplefilter("ignore", ConvergenceWarning)

    files, names, _ = draw(given.out / "test", 1, (308, 88, 66))
    test = features(files), names
    sets, whites = {"the simulator's own": []}, []
    for seed in range(1, given.seeds + 1):
        files, names, found = draw(given.out / f"own{seed}", 1 + seed, (130, 130, 130))
        sets["the simulator's own"].append((features(files), names))
        whites += found
    for kind, knows_looks in (("sizes and display", False), ("sizes, display and looks", True)):
        sets[f"recipe sonar, by {kind}"] = []
        for seed in range(1, given.seeds + 1):
            folder = given.out / f"{'looks' if knows_looks else 'sizes'}{seed}"
            files, names = generated(given.generator, folder, seed, whites, knows_looks)
            sets[f"recipe sonar, by {kind}"].append((features(files), names))
    print("| training pictures | sets of 390 | all together | confusion, sets added |\n|---|---|---:|---|")
    for kind, samples in sets.items():
        results = [train_and_test(sample, test) for sample in samples]
        together, _ = train_and_test((np.concatenate([s[0] for s in samples]), sum((s[1] for s in samples), [])), test)
        matrix = np.sum([matrix for _, matrix in results], axis=0).tolist()
        print(f"| {kind} | {', '.join(f'{accuracy:.3f}' for accuracy, _ in results)} | {together:.3f} | {matrix} |", flush=True)


if __name__ == "__main__":
    main()
