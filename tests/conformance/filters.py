#!/usr/bin/env python3
"""Compares filters with scikit-image's and Octave's: filters.py <conformance_filters> [folder of real pictures]

Exits with 77 where scikit-image is not installed; without Octave and its image package, its comparisons are skipped
with a message.
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from skimage import color, exposure, io, util
except ImportError:
    print("Skipped: scikit-image is not installed (Debian, Ubuntu: python3-skimage)")
    sys.exit(77)

TOOL = sys.argv[1]
PICTURES = sorted(pathlib.Path(sys.argv[2]).rglob("*.png")) if len(sys.argv) > 2 else []
LARGEST = {"8": 255, "16": 65535, "float": 1}
rng = np.random.default_rng(20)
failures = []


def check(holds, message):
    if not holds:
        failures.append(message)


def write(path, picture):
    """PGM, PPM or PFM by the array's type and shape."""
    height, width = picture.shape[:2]
    if picture.dtype == np.float32:
        data = b"Pf\n%d %d\n-1\n" % (width, height) + picture[::-1].astype("<f4").tobytes()
    else:
        magic = b"P6" if picture.ndim == 3 else b"P5"
        largest = np.iinfo(picture.dtype).max
        data = magic + b"\n%d %d\n%d\n" % (width, height, largest) + picture.astype(picture.dtype.newbyteorder(">")).tobytes()
    path.write_bytes(data)


def read(path):
    magic, size, scale, data = path.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    if magic == b"Pf":
        return np.frombuffer(data, "<f4" if float(scale) < 0 else ">f4").reshape(height, width)[::-1]
    channels = (3,) if magic == b"P6" else ()
    return np.frombuffer(data, ">u1" if int(scale) == 255 else ">u2").reshape((height, width) + channels)


def gray_of(path):
    picture = io.imread(path)
    return util.img_as_float(picture[..., 0] if picture.ndim == 3 else picture)


def synthetic():
    """A picture of random contrast, skew and number of levels."""
    height, width = rng.integers(8, 160, 2)
    y, x = np.mgrid[0:height, 0:width]
    relief = np.sin(x / rng.uniform(2, 30)) + np.sin(y / rng.uniform(2, 30)) + rng.normal(0, rng.uniform(0.01, 1), (height, width))
    relief = (relief - relief.min()) / np.ptp(relief)
    low, high = np.sort(rng.uniform(0, 1, 2))
    levels = rng.choice([1, 2, 7, 60, 255, 65535])
    return np.round((low + (high - low) * relief ** rng.uniform(0.3, 4)) * levels) / levels


def patch():
    """A real picture, or a part of one."""
    picture = gray_of(rng.choice(PICTURES))
    height, width = (int(rng.integers(min(40, n), min(400, n) + 1)) for n in picture.shape)
    top, left = rng.integers(0, picture.shape[0] - height + 1), rng.integers(0, picture.shape[1] - width + 1)
    return picture[top:top + height, left:left + width]


def as_kind(picture, kind):
    if kind == "float":
        return picture.astype(np.float32)
    return np.round(picture * LARGEST[kind]).astype(np.uint8 if kind == "8" else np.uint16)


def has_octave():
    """Whether Octave and its image package are installed."""
    if shutil.which("octave") is None:
        return False
    return subprocess.run(["octave", "--no-gui", "--quiet", "--eval", "pkg load image"], capture_output=True).returncode == 0


def histeq_map(source, wanted, levels):
    """histeq(I, hgram) as MATLAB documents it, by its matrix of differences."""
    nn = np.bincount(source.ravel(), minlength=levels).astype(float)
    cumulative = np.cumsum(nn)
    reached = np.cumsum(wanted) * nn.sum() / np.sum(wanted)
    slack = nn / 2
    slack[0] = slack[-1] = 0
    first = np.searchsorted(reached, cumulative - slack - nn.sum() * 2.0 ** -26)
    return np.minimum(first, len(wanted) - 1) / (len(wanted) - 1)


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    jobs = []

    def job(what, kind, source, argument):
        result = folder / f"{len(jobs)}.result"
        jobs.append(f"{what} {kind} {source} {argument} {result}\n")
        return result

    # 100 pairs: half of those of each kind are of real pictures where there are any.
    pairs = []
    for i in range(100):
        kind = ("8", "16", "float", "8")[i % 4]
        make = patch if PICTURES and i // 4 % 2 == 0 else synthetic
        source, reference = as_kind(make(), kind), as_kind(make(), kind)
        paths = [folder / f"{i}.source", folder / f"{i}.reference"]
        write(paths[0], source)
        write(paths[1], reference)
        bins = int(rng.choice([2, 16, 64, 64, 256]))
        pairs.append((i, kind, source, reference, bins, job("match", kind, *paths),
                      job("bins", kind, paths[0], f"{bins}:{paths[1]}"), job("count", kind, paths[0], bins), paths))

    colors = rng.integers(0, 256, (50, 60, 3), dtype=np.uint8)
    write(folder / "colors", colors)
    gray = {by: job("gray", "rgb", folder / "colors", by) for by in ("rec709", "octave")}
    tables = {by: job("table", "rgb", "-", by) for by in ("copper", "hot")}
    flat = np.full((1000, 1000), 128, np.uint8)
    write(folder / "flat", flat)
    noises = {"gaussian": "0.05", "gaussian_speckle": "0.04", "salt_and_pepper": "0.05"}
    noisy = {what: job(what, "8", folder / "flat", argument) for what, argument in noises.items()}
    subprocess.run([TOOL], input="".join(jobs), text=True, check=True)

    worst = 0
    for i, kind, source, reference, bins, matched, binned, counted, _ in pairs:
        step = 1 if kind != "float" else 1 / 255
        found = read(matched).astype(float)
        difference = np.abs(found - exposure.match_histograms(source, reference)).max() / step
        worst = max(worst, difference)
        check(difference <= (0.505 if kind != "float" else 1e-4), f"pair {i}, {kind}: {difference} levels from scikit-image's match")

        counts = read(counted)[0]
        scaled = source.astype(np.float64) / LARGEST[kind]
        expected = np.bincount(np.floor(scaled * (bins - 1) + 0.5 + 1e-12).astype(int).ravel(), minlength=bins)
        check((counts == expected).all(), f"pair {i}, {kind}: the histogram of {bins} bins")

        codes = source if kind != "float" else np.floor(source.astype(np.float64) * 255 + 0.5).astype(int)
        wanted = np.bincount(np.floor(reference.astype(np.float64) / LARGEST[kind] * (bins - 1) + 0.5 + 1e-12).astype(int).ravel(),
                             minlength=bins)
        values = histeq_map(codes, wanted, 65536 if kind == "16" else 256)[codes]
        difference = np.abs(read(binned) - values * LARGEST[kind]).max() / step
        check(difference <= 0.505, f"pair {i}, {kind}: {difference} levels from histeq's rule at {bins} bins")
    print(f"{len(pairs)} pairs, {len(PICTURES)} real pictures: at most {worst:.3f} levels from scikit-image's match")

    difference = np.abs(read(gray["rec709"]) - 255 * color.rgb2gray(colors)).max()
    check(difference <= 0.501, f"gray: {difference} levels from scikit-image's rgb2gray")

    if not has_octave():
        print("Skipped: Octave or its image package is not installed (Debian, Ubuntu: octave octave-image)")
    else:
        lines = ["pkg load image; warning off all;", f"cd '{folder}';"]

        def octave_reads(variable, path, picture):
            """netpbm by its bytes, as Octave's imread may not be built for it."""
            kind = {"uint8": "uint8", "uint16": "uint16", "float32": "single"}[picture.dtype.name]
            np.ascontiguousarray(picture.T if picture.ndim == 2 else picture.transpose(2, 1, 0)).tofile(path)
            shape = f"{picture.shape[0]},{picture.shape[1]}" + (",3" if picture.ndim == 3 else "")
            return f"f=fopen('{path}'); {variable}=reshape(fread(f,Inf,'{kind}=>{kind}'),{shape}); fclose(f);"

        for i, kind, source, reference, *_ in pairs:
            lines += [octave_reads("s", folder / f"s{i}", source), octave_reads("r", folder / f"r{i}", reference),
                      # Shares of present values, and interp1 between them.
                      "[v,~,j]=unique(double(s(:))); q=cumsum(accumarray(j,1))/numel(s);",
                      "[w,~,k]=unique(double(r(:))); p=cumsum(accumarray(k,1))/numel(r);",
                      "if numel(w)==1, m=repmat(w,size(q)); else, m=interp1(p,w,q,'linear'); m(q<=p(1))=w(1); m(q>=p(end))=w(end); end;",
                      f"f=fopen('m{i}','w'); fwrite(f,reshape(m(j),size(s)),'double'); fclose(f);",
                      f"f=fopen('h{i}','w'); fwrite(f,imhist(s),'double'); fclose(f);"]
        lines += [octave_reads("c", folder / "c", colors), "f=fopen('g','w'); fwrite(f,rgb2gray(c),'uint8'); fclose(f);",
                  "f=fopen('copper','w'); fwrite(f,copper(256)*255,'double'); fclose(f);",
                  "f=fopen('hot','w'); fwrite(f,hot(256)*255,'double'); fclose(f);",
                  "n=uint8(128*ones(1000)); function w(x), f=fopen(x{1},'w'); fwrite(f,x{2},'uint8'); fclose(f); end;",
                  "w({'gaussian',imnoise(n,'gaussian',0,0.05)}); w({'gaussian_speckle',imnoise(n,'speckle',0.04)});",
                  "w({'salt_and_pepper',imnoise(n,'salt & pepper',0.05)});"]
        (folder / "script.m").write_text("1;\n" + "\n".join(lines))
        octave = subprocess.run(["octave", "--no-gui", "--quiet", str(folder / "script.m")], stderr=subprocess.PIPE, text=True,
                                errors="replace")

        def octave_result(file, kind, shape):
            if not (folder / file).exists():
                sys.exit("\n".join(failures + [f"Octave (status {octave.returncode}) wrote no {file}:", octave.stderr]))
            return np.fromfile(folder / file, kind).reshape(shape[::-1]).T

        worst = 0
        for i, kind, source, _, _, matched, *_ in pairs:
            step = 1 if kind != "float" else 1 / 255
            difference = np.abs(read(matched) - octave_result(f"m{i}", "f8", source.shape)).max() / step
            worst = max(worst, difference)
            check(difference <= (0.505 if kind != "float" else 1e-4), f"pair {i}, {kind}: {difference} levels from Octave's match")
            if kind == "8":
                check((octave_result(f"h{i}", "f8", (256, 1))[:, 0] == np.bincount(source.ravel(), minlength=256)).all(), f"pair {i}: imhist")
        print(f"At most {worst:.3f} levels from the same rule by Octave's interp1")
        check((octave_result("g", "u1", (50, 60)) == read(gray["octave"])).mean() > 0.999, "gray: Octave's rgb2gray")
        check(np.abs(octave_result("g", "u1", (50, 60)).astype(int) - read(gray["octave"])).max() <= 1, "gray: a level from Octave's")
        for by in ("copper", "hot"):
            difference = np.abs(read(tables[by])[0] - octave_result(by, "f8", (256, 3))).max()
            check(difference <= 0.5 + 1e-9, f"{by}: {difference} levels from Octave's")
        for what in noises:
            ours, theirs = read(noisy[what]).astype(float), octave_result(what, "u1", flat.shape).astype(float)
            check(abs(ours.mean() - theirs.mean()) < 5 * theirs.std() / 1000 * 2 ** 0.5, f"{what}: mean {ours.mean()}, Octave {theirs.mean()}")
            fourth = np.mean((theirs - theirs.mean()) ** 4)
            error = (fourth - theirs.var() ** 2) ** 0.5 / 1000
            check(abs(ours.var() - theirs.var()) < 5 * error * 2 ** 0.5, f"{what}: variance {ours.var()}, Octave {theirs.var()}")

print("\n".join(failures) if failures else "All agree")
sys.exit(1 if failures else 0)
