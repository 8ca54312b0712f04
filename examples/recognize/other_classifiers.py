#!/usr/bin/env python3
"""Trains classifiers that played no part in choosing the recipe, on generated sets and, to compare, on 80 real images.

    examples/recognize/other_classifiers.py REAL SET...

REAL has the folders plane/, ship/ and seafloor/ of real images, each SET is a folder of generate_dataset's recipe sonar.
Prints area under the ROC curve / balanced accuracy of object or bare bottom, and the balanced accuracy of plane, ship or
bottom. The 80 real images, half of them bare, are drawn five times and tested on the rest; sets are tested on all real
images. Needs numpy, scipy, scikit-image and scikit-learn.
"""

import argparse
import pathlib
import warnings

import numpy as np
from scipy.ndimage import gaussian_filter
from skimage.color import rgb2gray
from skimage.feature import hog, local_binary_pattern
from skimage.io import imread
from skimage.transform import resize
from sklearn.ensemble import ExtraTreesClassifier, HistGradientBoostingClassifier
from sklearn.linear_model import LogisticRegression
from sklearn.metrics import balanced_accuracy_score, roc_auc_score
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVC, LinearSVC

SIDE = 64


def chip(path):
    """64 x 64 pixels from 0 to 1, stretched from the first to the last percentile."""
    image = imread(path)
    gray = rgb2gray(image[..., :3]) if image.ndim == 3 else image / 255.0
    gray = resize(gray.astype(float), (SIDE, SIDE), anti_aliasing=True)
    low, high = np.percentile(gray, (1, 99))
    return np.clip((gray - low) / (high - low + 1e-9), 0, 1)


def gradients(image, cell=8):
    return hog(image, orientations=9, pixels_per_cell=(cell, cell), cells_per_block=(2, 2))


def smooth_gradients(image):
    return gradients(gaussian_filter(image, 1.5), 16)


def binary_patterns(image):
    """Histograms of uniform local binary patterns at three scales."""
    found = []
    for blur, points, radius in ((0, 8, 1), (1, 8, 2), (2, 8, 4)):
        codes = (gaussian_filter(image, blur) * 255).astype(np.uint8)
        pattern = local_binary_pattern(codes, points, radius, "uniform")
        found.append(np.histogram(pattern, bins=points + 2, range=(0, points + 2), density=True)[0])
    return np.concatenate(found)


def spectrum(image):
    """Logarithms of the power spectrum's means over eight bands of wave number and four of direction."""
    window = np.outer(np.hanning(SIDE), np.hanning(SIDE))
    power = np.abs(np.fft.fftshift(np.fft.fft2((image - image.mean()) * window))) ** 2
    y, x = np.mgrid[-SIDE // 2 : SIDE // 2, -SIDE // 2 : SIDE // 2]
    number, direction = np.hypot(x, y), ((np.arctan2(y, x) % np.pi) * 4 / np.pi).astype(int) % 4
    bands = [(number >= 2 ** (0.6 * k)) & (number < 2 ** (0.6 * (k + 1))) for k in range(8)]
    parts = [band & (direction == d) for band in bands for d in range(4)]
    return np.array([np.log(power[part].mean() + 1e-9) if part.any() else 0 for part in parts])


def scaled(classifier):
    return make_pipeline(StandardScaler(), classifier)


CLASSIFIERS = {
    "gradients, linear SVM": (gradients, scaled(LinearSVC(C=3e-4, max_iter=5000))),
    "gradients, RBF SVM": (gradients, scaled(SVC(C=3))),
    "smoothed gradients, boosted trees": (smooth_gradients, HistGradientBoostingClassifier(random_state=0)),
    "binary patterns, extra trees": (binary_patterns, ExtraTreesClassifier(300, random_state=0, class_weight="balanced")),
    "binary patterns, logistic regression": (binary_patterns, scaled(LogisticRegression(C=0.1, max_iter=2000))),
    "spectrum, RBF SVM": (spectrum, scaled(SVC(C=1))),
}
CLASSES = ("plane", "ship", "seafloor")


def load(folder, names):
    """Chips, and the number of each one's class."""
    files = [(path, k) for k, name in enumerate(names) for path in sorted((folder / name).rglob("*.*"))]
    return [chip(path) for path, _ in files], np.array([k for _, k in files])


def object_or_bare(classifier, rows, classes, test_rows, test_classes):
    """Area under the ROC curve, balanced accuracy."""
    classifier.fit(rows, classes < 2)
    has_margin = hasattr(classifier, "decision_function")
    scores = classifier.decision_function(test_rows) if has_margin else classifier.predict_proba(test_rows)[:, 1] - 0.5
    return roc_auc_score(test_classes < 2, scores), balanced_accuracy_score(test_classes < 2, scores > 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=pathlib.Path, help="folder of real images")
    parser.add_argument("sets", type=pathlib.Path, nargs="+", help="folder of a set")
    given = parser.parse_args()
    warnings.simplefilter("ignore")

    real, classes = load(given.real, CLASSES)
    sets = [load(folder / "images", ("plane", "ship", "empty")) for folder in given.sets]
    print("| classifier | 80 real ones | " + " | ".join(folder.name for folder in given.sets) +
          " | three classes |\n|---|---|" + "---|" * len(sets) + "---|")
    for name, (features, classifier) in CLASSIFIERS.items():
        rows = np.array([features(image) for image in real])
        few = []
        for seed in range(5):
            g = np.random.default_rng(seed)
            drawn = np.concatenate([g.choice(np.flatnonzero(group), 40, False) for group in (classes < 2, classes == 2)])
            others = np.setdiff1d(np.arange(len(classes)), drawn)
            few.append(object_or_bare(classifier, rows[drawn], classes[drawn], rows[others], classes[others]))
        cells, three = ["{:.3f} / {:.3f}".format(*np.mean(few, axis=0))], []
        for images, of in sets:
            made = np.array([features(image) for image in images])
            cells.append("{:.3f} / {:.3f}".format(*object_or_bare(classifier, made, of, rows, classes)))
            classifier.fit(made, of)
            three.append(balanced_accuracy_score(classes, classifier.predict(rows)))
        print(f"| {name} | " + " | ".join(cells) + " | " + ", ".join(f"{t:.3f}" for t in three) + " |", flush=True)


main()
