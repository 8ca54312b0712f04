#!/usr/bin/env python3
"""Makes the pictures of README.md and the guide from the programs' output: annotate.py <folder of the output> <docs/guide>

Adds a margin with the direction of the sound and a scale bar, and stores few levels, so that each file stays small.
"""

import argparse
import csv
import pathlib

from PIL import Image, ImageDraw

INK, PAPER = (20, 20, 20), (255, 255, 255)


class Overhead:
    """A picture from above, lit from the left; metres across at the datum."""

    def __init__(self, metres, levels=12):
        self.metres, self.levels = metres, levels

    def margin(self, draw, left, top, width, height):
        below = top + height
        draw.text((left + 6, below + 8), "sound travels to the right", INK)
        arrow(draw, left + 166, below + 14, 40)
        scale_bar(draw, left + width - 6, below + 12, width / self.metres, self.metres)


class Swath:
    """Both sides of a track, forward up or down; columns are slant range to either side.

    Without metres along the track, `above` says what the picture shows.
    """

    def __init__(self, metres_to_a_side, metres_along=None, levels=12, step=10, forward="up", above=""):
        self.side, self.along, self.levels, self.step = metres_to_a_side, metres_along, levels, step
        self.forward, self.above = forward, above

    def margin(self, draw, left, top, width, height):
        below, middle = top + height, left + width / 2
        step = self.step
        for mark in range(-int(self.side / step) * step, int(self.side) + 1, step):
            x = middle + mark * width / (2 * self.side)
            draw.line([(x, below), (x, below + 5)], INK)
            text(draw, min(x, left + width - 7), below + 7, str(abs(mark)))
        text(draw, left + 130, below + 22, "port: slant range, m")
        text(draw, left + width - 130, below + 22, "starboard: slant range, m")
        text(draw, middle, below + 22, f"sonar's track, forward {self.forward}")
        text(draw, left + 2, 2, self.above or "distance along the track, m", anchor="left")
        if self.along is None:
            return
        for mark in range(0, int(self.along) + 1, step):
            y = mark * height / self.along
            y = below - y if self.forward == "up" else top + y
            draw.line([(left - 5, y), (left, y)], INK)
            text(draw, left - 14, y - 5, str(mark))


class Plain:
    """A picture that is not of a sonar."""

    def __init__(self, caption, levels=16):
        self.caption, self.levels = caption, levels

    def margin(self, draw, left, top, width, height):
        draw.text((left + 6, top + height + 8), self.caption, INK)


# What each program's picture shows: of an overhead rig, 2 altitude tan(field of view / 2) metres.
PICTURES = {
    "cylinder.png": Overhead(8.0),
    "scene.png": Overhead(8.0),
    "filter.png": Overhead(13.86, levels=8),
    "waves.png": Overhead(13.86),
    "survey_bottom.png": Overhead(13.86),
    "block.png": Overhead(13.86),
    "line.png": Swath(32, 50.4, levels=8),
    "swath.png": Swath(20, 20, levels=8, step=5, forward="down"),
    "beside_real.png": Swath(30, levels=32, forward="down", above="above: rendered; below: recorded, CIDCO OpenSidescan (MIT)"),
    "shader.png": Plain("hull of 24 m, a line for every metre from the sonar"),
    "ball.png": Plain("a ball of 2 m, seen from 4.3 m"),
}
SHRUNK = {"cylinder.png": (512, 512), "line.png": (880, 280), "beside_real.png": (1024, 467)}
IN_DOCS = {"cylinder.png", "swath.png", "beside_real.png"}  # the others belong to the guide


# Where the sound travels on a chip, right, up, left or down: of its manifest's quarter turns, and of 4 more if mirrored.
DIRECTIONS = [(1, 0), (0, -1), (-1, 0), (0, 1)]


def direction(turn):
    return DIRECTIONS[(turn + 2) % 4] if turn >= 4 else DIRECTIONS[turn]


# A recorded line: both sides of 29.98 m in slant range, forward down. From CIDCO-dev/OpenSidescan, MIT licence.
REAL_LINE = pathlib.Path("../shared/reference/sidescan_scotsman/waterfall_u8_linear.png")
REAL_RANGE, REAL_COLUMN, REAL_ROW = 29.98, 29.98 / 1024, 0.067  # metres: to a side, from column to column, row to row
# The chips of README.md's picture: generated ones of the guide's data set `boats`, and parts of the recorded line (column and
# row of the middle, metres).
CHIPS = ["ship/000000/000000002", ("ship", 1390, 270, 15), "ship/000000/000000001", "empty/000000/000000014",
         ("bottom", 450, 130, 10), "plane/000000/000000009", "plane/000000/000000007", "tyre/000000/000000011"]


def copper(gray):
    """The library's colormap::copper."""
    return Image.merge("RGB", [gray.point(lambda v, k=k: min(255, round(k * v))) for k in (1.25, 0.7812, 0.4975)])


def generated_chip(data_set, name, row):
    """The picture of a chip, its caption, its extent in range, and where the sound travels."""
    kind = name.split("/")[0]
    picture = Image.open(data_set / "images" / f"{name}.png").convert("L")
    words = "generated: " + ("bottom" if kind == "empty" else kind)
    return picture, words, float(row["chip_m"]), direction(int(row["turn"]))


def recorded_chip(line, kind, column, row, metres):
    """The same of a square part of a recorded line around a column and a row."""
    x, y = metres / 2 / REAL_COLUMN, metres / 2 / REAL_ROW
    picture = line.crop((round(column - x), round(row - y), round(column + x), round(row + y)))
    return picture, f"recorded: {kind}", metres, (1 if column > line.width / 2 else -1, 0)


def front(source, target):
    """The guide's survey line beside a recorded one, above chips of the guide's data set and of the recorded line.

    Both lines have slant range across, with the track in the middle; chips have their extent in range.
    """
    width, height, side, gap = 455, 234, 110, 5
    line = Image.open(source / "line.png").convert("RGB").getchannel("G").point(lambda v: round(v / 0.7812))
    metre = line.height / 50.4
    line = line.crop((0, round(line.height - 43 * metre), line.width, round(line.height - 10 * metre)))
    panels = [("generated", line, 32)]
    if REAL_LINE.exists():
        recorded = Image.open(REAL_LINE).convert("L")
        panels.append(("recorded, CIDCO OpenSidescan (MIT)", recorded, REAL_RANGE))
    sheet = Image.new("RGB", (2 * width + 10, height + side + 96), PAPER)
    draw = ImageDraw.Draw(sheet)
    for k, (words, panel, metres) in enumerate(panels):
        left = k * (width + 10)
        sheet.paste(copper(panel.resize((width, height), Image.Resampling.BOX)), (left, 0))
        for mark in range(-int(metres / 10) * 10, int(metres) + 1, 10):
            x = left + width / 2 + mark * width / (2 * metres)
            draw.line([(x, height), (x, height + 4)], INK)
            text(draw, min(max(x, left + 7), left + width - 7), height + 6, str(abs(mark)))
        text(draw, left + width / 2, height + 20, f"{words}: slant range from the track, m")
    with (source / "boats/manifest.csv").open(newline="") as table:
        rows = {row["file"]: row for row in csv.DictReader(table)}
    for k, chip in enumerate(CHIPS):
        if isinstance(chip, str):
            picture, words, metres, (x, y) = generated_chip(source / "boats", chip, rows[f"images/{chip}.png"])
        elif REAL_LINE.exists():
            picture, words, metres, (x, y) = recorded_chip(recorded, *chip)
        else:
            continue
        left, middle = k * (side + gap), k * (side + gap) + side / 2
        picture = picture.resize((side, side), Image.Resampling.BOX)
        sheet.paste(picture.convert("RGB").point(lambda v: round(v / 36.4) * 36), (left, height + 40))
        text(draw, middle, height + side + 44, words)
        text(draw, middle - 14, height + side + 60, f"{metres:.1f} m")
        arrow(draw, middle + 24 - 7 * x, height + side + 66 - 7 * y, 14, (x, y))
    text(draw, width + 5, height + side + 79, "Chips: extent in range; arrows point away from the sonar.")
    save(sheet, target.parent / "front.png", 64)


def save(sheet, path, colors=16):
    sheet.quantize(colors, dither=Image.Dither.NONE).save(path, optimize=True, bits=4 if colors <= 16 else 8)
    print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")


def text(draw, x, y, words, anchor="middle"):
    box = draw.textbbox((0, 0), words)
    draw.text((x - (box[2] / 2 if anchor == "middle" else 0), y), words, INK)


def posterized(picture, levels):
    """A picture of one colour ramp, reduced to `levels` colours that are evenly spaced in brightness."""
    gray = picture.convert("L")
    darkest, brightest = gray.getextrema()
    step = (brightest - darkest) / (levels - 1) or 1
    mean = {}
    for count, color in picture.getcolors(1 << 24):
        level = round((0.299 * color[0] + 0.587 * color[1] + 0.114 * color[2] - darkest) / step)
        total = mean.setdefault(min(max(level, 0), levels - 1), [0, 0, 0, 0])
        for channel in range(3):
            total[channel] += count * color[channel]
        total[3] += count
    palette = {level: tuple(round(t / total[3]) for t in total[:3]) for level, total in mean.items()}
    tables = [palette.get(min(max(round((v - darkest) / step), 0), levels - 1), (0, 0, 0)) for v in range(256)]
    return Image.merge("RGB", [gray.point([t[channel] for t in tables]) for channel in range(3)])


def arrow(draw, x, y, length, along=(1, 0)):
    u, v = along
    tip, neck = (x + u * length, y + v * length), (x + u * (length - 7), y + v * (length - 7))
    draw.line([(x, y), tip], INK)
    draw.polygon([tip, (neck[0] - 4 * v, neck[1] - 4 * u), (neck[0] + 4 * v, neck[1] + 4 * u)], INK)


def scale_bar(draw, right, y, pixels_per_metre, metres):
    length = next(n for n in (20, 10, 5, 2, 1, 0.5) if n <= metres / 4)
    left = right - length * pixels_per_metre
    draw.line([(left, y), (right, y)], INK, 3)
    for x in (left, right):
        draw.line([(x, y - 5), (x, y + 5)], INK)
    draw.text((left - 32, y - 4), f"{length:g} m", INK)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("target", type=pathlib.Path)
    given = parser.parse_args()
    source, target = given.source, given.target
    for name, kind in PICTURES.items():
        if not (source / name).exists():
            print(f"{name}: not drawn")
            continue
        picture = Image.open(source / name).convert("RGB")
        if name in SHRUNK:
            picture = picture.resize(SHRUNK[name], Image.Resampling.BOX)
        left, top, below = (30, 16, 40) if isinstance(kind, Swath) else (0, 0, 30)
        sheet = Image.new("RGB", (picture.width + left, picture.height + top + below), PAPER)
        sheet.paste(posterized(picture, kind.levels), (left, top))
        kind.margin(ImageDraw.Draw(sheet), left, top, picture.width, picture.height)
        save(sheet, (target.parent if name in IN_DOCS else target) / name)
    if (source / "boats").exists() and (target / "line.png").exists():
        front(source, target)


main()
