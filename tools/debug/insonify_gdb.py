"""Prints images, views and poses in gdb: source tools/debug/insonify_gdb.py"""

import math
import re

import gdb


class Picture:
    """Prints the size, and the pixels of small images row by row."""

    MAX_PIXELS = 64

    def __init__(self, value, is_view):
        self.value, self.is_view = value, is_view
        self.width, self.height = int(value["width_"]), int(value["height_"])

    def to_string(self):
        kind = "view" if self.is_view else "image"
        return f"{kind} of {self.width} x {self.height} {self.value.type.strip_typedefs().template_argument(0)}"

    def children(self):
        if self.width * self.height > self.MAX_PIXELS:
            return
        if self.is_view:
            first, stride = self.value["data_"], int(self.value["stride_"])
        else:
            pixel = self.value.type.strip_typedefs().template_argument(0)
            first, stride = self.value["pixels_"]["memory_"]["start_"].cast(pixel.pointer()), self.width
        for y in range(self.height):
            for x in range(self.width):
                yield f"({x}, {y})", (first + y * stride + x).dereference()


class Pose:
    def __init__(self, value):
        self.value = value

    def to_string(self):
        at = self.value["position"]
        x, y, z = (float(at[axis]) for axis in "xyz")
        angles = ", ".join(f"{name} {math.degrees(float(self.value[name])):g} deg" for name in ("yaw", "pitch", "roll"))
        return (f"pose at ({x:g}, {y:g}, {z:g}) m, {angles}, scale {float(self.value['scale']):g}, "
                f"burial {float(self.value['burial']):g}")


def printer_of(value):
    name = str(value.type.strip_typedefs().unqualified())
    if re.match(r"insonify::(\w+::)?image<", name):
        return Picture(value, False)
    if re.match(r"insonify::(\w+::)?image_view<", name):
        return Picture(value, True)
    if re.match(r"insonify::(\w+::)?pose$", name):
        return Pose(value)
    return None


gdb.pretty_printers.append(printer_of)
