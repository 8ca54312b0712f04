#!/usr/bin/env python3
"""Draws the figures of docs/how_it_works.md: how_it_works.py docs/how_it_works

All positions are computed from the numbers at the top of each function, in the units of the axes.
"""

import argparse
import math
import pathlib

INK, FAINT, LIT, DARK, HOT = "#223", "#9ab", "#e8c890", "#333a44", "#c0392b"


class Plot:
    """Axes with units, y up, drawn into a box of pixels."""

    def __init__(self, width, height, x_range, y_range, x_label, y_label, equal=False):
        self.size, self.body = (width, height), []
        self.left, self.right, self.top, self.bottom = 62, width - 16, 18, height - 46
        self.x0, self.x1 = x_range
        self.y0, self.y1 = y_range
        if equal:  # the same pixels per unit along both axes
            unit = (self.right - self.left) / (self.x1 - self.x0)
            self.bottom = self.top + unit * (self.y1 - self.y0)
            self.size = (width, round(self.bottom + 46))
        self.label(x_label, y_label)

    def at(self, x, y):
        return (self.left + (x - self.x0) / (self.x1 - self.x0) * (self.right - self.left),
                self.bottom - (y - self.y0) / (self.y1 - self.y0) * (self.bottom - self.top))

    def add(self, text):
        self.body.append(text)

    def line(self, points, color=INK, width=1.5, more=""):
        path = " ".join("%.1f,%.1f" % self.at(*p) for p in points)
        self.add(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="{width}" {more}/>')

    def area(self, points, fill, more=""):
        path = " ".join("%.1f,%.1f" % self.at(*p) for p in points)
        self.add(f'<polygon points="{path}" fill="{fill}" {more}/>')

    def dot(self, x, y, radius=3, fill=INK, more=""):
        px, py = self.at(x, y)
        self.add(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="{radius}" fill="{fill}" {more}/>')

    def text(self, x, y, words, anchor="middle", color=INK, shift=(0, 0)):
        px, py = self.at(x, y)
        self.add(f'<text x="{px + shift[0]:.1f}" y="{py + shift[1]:.1f}" text-anchor="{anchor}" fill="{color}">{words}</text>')

    def label(self, x_label, y_label):
        middle = (self.left + self.right) / 2
        self.add(f'<text x="{middle}" y="{self.bottom + 38:.0f}" text-anchor="middle">{x_label}</text>')
        high = (self.top + self.bottom) / 2
        self.add(f'<text transform="translate(16 {high:.0f}) rotate(-90)" text-anchor="middle">{y_label}</text>')

    def ticks(self, xs, ys):
        for x in xs:
            px, py = self.at(x, self.y0)
            self.add(f'<line x1="{px:.1f}" y1="{py:.1f}" x2="{px:.1f}" y2="{py + 5:.1f}" stroke="{INK}"/>')
            self.add(f'<text x="{px:.1f}" y="{py + 18:.1f}" text-anchor="middle">{x:g}</text>')
        for y in ys:
            px, py = self.at(self.x0, y)
            self.add(f'<line x1="{px - 5:.1f}" y1="{py:.1f}" x2="{px:.1f}" y2="{py:.1f}" stroke="{INK}"/>')
            self.add(f'<text x="{px - 8:.1f}" y="{py + 4:.1f}" text-anchor="end">{y:g}</text>')

    def svg(self):
        return page(*self.size, self.body)


def page(w, h, body):
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{w}" height="{h}" viewBox="0 0 {w} {h}" '
            f'font-family="sans-serif" font-size="12">\n<rect width="100%" height="100%" fill="white"/>\n'
            + "\n".join(body) + "\n</svg>\n")


def stacked(upper, lower):
    """Two plots of one page, the second below the first."""
    down = upper.size[1] - 24  # the upper plot has no label below
    return page(upper.size[0], down + lower.size[1],
                upper.body + [f'<g transform="translate(0 {down})">'] + lower.body + ["</g>"])


def triangle():
    """Pixels whose centres a triangle covers."""
    corners = [(1.3, 6.4), (10.6, 4.9), (5.2, 0.7)]
    p = Plot(560, 0, (0, 12), (0, 8), "pixels", "pixels", equal=True)

    def inside(x, y):
        edges = [(corners[i], corners[(i + 1) % 3]) for i in range(3)]
        signs = [(bx - ax) * (y - ay) - (by - ay) * (x - ax) for (ax, ay), (bx, by) in edges]
        return all(s <= 0 for s in signs) or all(s >= 0 for s in signs)

    for row in range(8):
        for column in range(12):
            covered = inside(column + 0.5, row + 0.5)
            p.area([(column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1)],
                   LIT if covered else "white", f'stroke="{FAINT}"')
    for row in range(8):
        for column in range(12):
            p.dot(column + 0.5, row + 0.5, 1.8, INK if inside(column + 0.5, row + 0.5) else FAINT)
    p.line(corners + corners[:1], HOT, 2)
    for x, y in corners:
        p.dot(x, y, 4, HOT)
    p.text(1.3, 6.4, "corner, rounded to a fraction of a pixel", "start", HOT, (4, -10))
    p.ticks(range(0, 13, 2), range(0, 9, 2))
    return p.svg()


def shadow():
    """A bottom under parallel light; below it u, where each point's ray meets z = 0, and the running maximum of u."""
    grazing, across = math.radians(17), 9.0
    cot = 1 / math.tan(grazing)

    def height(x):  # ripples, the third of them raised
        return 0.22 * math.cos(2 * math.pi * (x - 0.6) / 2.1) + 0.35 * math.exp(-((x - 4.8) / 0.7) ** 2)

    xs = [i * across / 1800 for i in range(1801)]
    feet = [x + height(x) * cot for x in xs]
    met = [feet[0]]
    for foot in feet[1:]:
        met.append(max(met[-1], foot))
    dark = [foot < largest - 1e-9 for foot, largest in zip(feet, met)]
    runs, start = [], None
    for i, is_dark in enumerate(dark + [False]):
        if is_dark and start is None:
            start = i
        elif not is_dark and start is not None:
            runs.append((start, i - 1))
            start = None

    p = Plot(700, 0, (0, across), (-0.45, 1.45), "", "height, m", equal=True)
    p.area([(0, -0.45)] + [(x, height(x)) for x in xs] + [(across, -0.45)], "#d8c9a8")
    for first, last in runs:  # between a crest, the ray over it, and the bottom behind it
        if last < len(xs) - 1:
            p.area([(x, height(x)) for x in xs[first:last + 1]], DARK, 'opacity="0.35"')
        p.line([(x, height(x)) for x in xs[first:last + 1]], DARK, 3)
        x, z = xs[first], height(xs[first])
        ends = xs[last] if last < len(xs) - 1 else across
        p.line([(x - (1.4 - z) * cot, 1.4) if x > (1.4 - z) * cot else (0, z + x / cot), (ends, z - (ends - x) / cot)],
               HOT, 1.2, 'stroke-dasharray="5 3"')
    p.line([(0, 0), (across, 0)], FAINT, 1, 'stroke-dasharray="2 3"')
    p.text(across - 0.1, 1.2, "sound over the crests, 17 degrees above the bottom", "end", HOT)
    p.ticks(range(0, 10), (0, 1))

    q = Plot(700, 190, (0, across), (-1, 10), "across track, m", "u, m")
    for first, last in runs:
        q.area([(xs[first], met[first])] + [(x, u) for x, u in zip(xs[first:last + 1], feet[first:last + 1])] +
               [(xs[last], met[last])], DARK, 'opacity="0.35"')
    q.line(list(zip(xs, met)), HOT, 1.2, 'stroke-dasharray="5 3"')
    q.line(list(zip(xs, feet)), INK, 1.5)
    for first, last in runs:
        q.line(list(zip(xs[first:last + 1], feet[first:last + 1])), DARK, 3)
    q.text(0.15, 9, "u: where a point's ray meets z = 0", "start", INK)
    q.text(0.15, 7.4, "dashed: the largest u so far; what lies below it is in shadow", "start", HOT)
    q.ticks(range(0, 10), (0, 5, 10))
    return stacked(p, q)


SONAR, BOX = 6.0, (14.0, 15.0, 0.8)  # altitude; ground range of the box from, to, and its height, metres


def ranges_of_box():
    near, far, height = BOX
    over = SONAR - height
    return {
        "top": math.hypot(near, over), "foot": math.hypot(near, SONAR), "edge": math.hypot(far, over),
        "end": math.hypot(far * SONAR / over, SONAR), "shadow_end": far * SONAR / over,
    }


def ping():
    near, far, height = BOX
    at = ranges_of_box()
    p = Plot(760, 0, (0, 22), (-0.8, 7), "ground range, m", "height, m", equal=True)
    p.area([(0, -0.8), (22, -0.8), (22, 0), (0, 0)], "#d8c9a8")
    p.area([(near, height), (far, height), (at["shadow_end"], 0), (far, 0), (near, 0)], DARK, 'opacity="0.35"')
    p.area([(near, 0), (near, height), (far, height), (far, 0)], LIT, f'stroke="{INK}"')
    for ground in (3, 6, 9, 12):
        p.line([(0, SONAR), (ground, 0)], FAINT, 1)
    p.line([(0, SONAR), (near, height)], HOT, 1.2)
    p.line([(0, SONAR), (at["shadow_end"], 0)], HOT, 1.2, 'stroke-dasharray="5 3"')
    p.line([(0, SONAR), (20.5, 0)], FAINT, 1)
    for radius in (SONAR, at["top"], at["end"]):  # points of equal range
        arc = [(radius * math.sin(a), SONAR - radius * math.cos(a)) for a in (math.pi / 2 * i / 60 for i in range(61))]
        p.line([q for q in arc if -0.01 <= q[1] <= 7], "#2a7", 1, 'stroke-dasharray="2 3"')
    p.dot(0, SONAR, 6, HOT)
    p.text(0.3, SONAR, "sonar, 6 m above the bottom", "start", HOT, (4, -8))
    p.text((near + far) / 2, 0, "target", shift=(0, 18))
    p.text((far + at["shadow_end"]) / 2, 0, "shadow", shift=(14, 18))
    p.text(10.2, 6.3, "arcs: points of equal range, heard at the same time", "start", "#175")
    p.ticks(range(0, 23, 2), range(0, 7, 2))
    return p.svg()


def echo():
    near, far, height = BOX
    at = ranges_of_box()
    p = Plot(760, 250, (0, 22), (0, 1.15), "slant range, m (half the time of the echo times the speed of sound)",
             "intensity, relative")

    def bottom(slant):  # Lambert's law, with the ranges' spreading undone by gain
        return 0 if slant < SONAR else 0.75 * (SONAR / slant) ** 2 + 0.12

    def heard(slant):
        if at["edge"] <= slant < at["end"]:
            return 0.01
        face = 0.7 if at["top"] <= slant < at["foot"] else 0
        top = 0.12 if at["top"] <= slant < at["edge"] else 0
        ground = bottom(slant) if slant < at["foot"] or slant >= at["end"] else 0
        return face + top + ground

    points = [(i * 0.02, heard(i * 0.02)) for i in range(1101)]
    p.area([(0, 0)] + points + [(22, 0)], LIT)
    p.line(points, INK, 1.2)
    p.text(3, 0.2, "water column: silence")
    p.text(10.4, 0.1, "bottom, weaker at lower grazing angles")
    p.text(at["top"], 1.03, "front face, before its foot: layover", "end", HOT, (-4, 0))
    p.text((at["edge"] + at["end"]) / 2, 0.06, "shadow", color=DARK)
    p.line([(0, 0), (22, 0)], INK, 1)
    p.ticks(range(0, 23, 2), (0, 0.5, 1))
    return p.svg()


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("folder", type=pathlib.Path)
folder = parser.parse_args().folder
for name in (triangle, shadow, ping, echo):
    (folder / f"{name.__name__}.svg").write_text(name())
