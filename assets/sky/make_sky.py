"""Makes stars.bin and milky-way.png, the two files of the sky that the game reads.

    python3 make_sky.py FOLDER        (needs numpy and scipy)

FOLDER holds hipparcos2.csv.gz (columns hip, ra_rad, dec_rad, parallax_mas, hp_mag, b_minus_v) and milky-way.geojson (brightness
contours ol1, the faintest, to ol5; longitude and latitude are right ascension and declination in degrees). Both files are written
beside this script. The same input gives the same bytes.

stars.bin, little-endian: 8 bytes "LRSTARS\\0", u32 version, u32 count, u32 CRC-32 of the records, u32 bytes in a record, then the
records from bright to faint: f32 right ascension, f32 declination (radians, ICRS, epoch 1991.25), i16 Hp magnitude, i16 B-V (both
in thousandths; -32768 where B-V is missing).

milky-way.png: 8-bit grey, equirectangular; the left edge is right ascension 0 and it grows to the right; the top is declination
+90 degrees. The grey value is 255 times the square root of the brightness.
"""

import csv
import gzip
import json
import struct
import sys
import zlib
from pathlib import Path

import numpy
from scipy.ndimage import gaussian_filter1d

HERE = Path(__file__).resolve().parent
VERSION = 1
MISSING = -32768
WIDTH, HEIGHT = 2048, 1024
# Brightness that each contour adds, and the blur that hides its step, in degrees: the faint contours lie far apart.
LEVELS = {"ol1": (0.09, 2.0), "ol2": (0.13, 1.3), "ol3": (0.18, 0.85), "ol4": (0.25, 0.7), "ol5": (0.32, 0.6)}


def make_stars(source, target):
    stars = []
    with gzip.open(source, "rt", newline="") as file:
        for row in csv.DictReader(file):
            colour = row["b_minus_v"]
            stars.append((round(float(row["hp_mag"]) * 1000), int(row["hip"]), float(row["ra_rad"]), float(row["dec_rad"]),
                          round(float(colour) * 1000) if colour else MISSING))
    stars.sort()
    body = b"".join(struct.pack("<ffhh", ra, dec, magnitude, colour) for magnitude, _, ra, dec, colour in stars)
    header = struct.pack("<8sIIII", b"LRSTARS\0", VERSION, len(stars), zlib.crc32(body), 12)
    target.write_bytes(header + body)
    print(f"{target.name}: {len(stars)} stars, {len(header) + len(body)} bytes")


def inside(polygons):
    """1 in the polygons, 0 outside, by the parity of the edges crossed on the meridian from the north pole, which is outside.

    Edges are taken the short way round in right ascension, so rings that go round the whole sky need no seam."""
    crossings = numpy.zeros((HEIGHT + 1, WIDTH), dtype=numpy.int32)
    for ring in (ring for polygon in polygons for ring in polygon):
        points = numpy.asarray(ring, dtype=float)
        columns = points[:, 0] / 360.0 * WIDTH - 0.5
        rows = (90.0 - points[:, 1]) / 180.0 * HEIGHT - 0.5
        for index in range(len(points)):
            start, row = columns[index - 1], rows[index - 1]
            step = (columns[index] - start + WIDTH / 2) % WIDTH - WIDTH / 2
            low, high = min(start, start + step), max(start, start + step)
            hit = numpy.arange(numpy.ceil(low), numpy.ceil(high))
            if len(hit):
                at = row + (rows[index] - row) * (hit - start) / step
                below = numpy.clip(numpy.ceil(at), 0, HEIGHT).astype(int)
                numpy.add.at(crossings, (below, hit.astype(int) % WIDTH), 1)
    return (numpy.cumsum(crossings, axis=0)[:HEIGHT] % 2).astype(float)


def blur(image, degrees):
    """A Gaussian blur of about this standard deviation on the sphere: along each row wider by 1 / cos(declination)."""
    image = gaussian_filter1d(image, degrees / 180.0 * HEIGHT, axis=0, mode="nearest")
    frequency = numpy.fft.rfftfreq(WIDTH)
    declination = numpy.pi / 2 - (numpy.arange(HEIGHT) + 0.5) * numpy.pi / HEIGHT
    sigma = degrees / 360.0 * WIDTH / numpy.maximum(numpy.cos(declination), 1e-3)
    damping = numpy.exp(-2.0 * (numpy.pi * numpy.outer(sigma, frequency)) ** 2)
    return numpy.fft.irfft(numpy.fft.rfft(image, axis=1) * damping, WIDTH, axis=1)


def directions():
    ra = (numpy.arange(WIDTH) + 0.5) * 2 * numpy.pi / WIDTH
    dec = numpy.pi / 2 - (numpy.arange(HEIGHT) + 0.5) * numpy.pi / HEIGHT
    ra, dec = numpy.meshgrid(ra, dec)
    return numpy.stack([numpy.cos(dec) * numpy.cos(ra), numpy.cos(dec) * numpy.sin(ra), numpy.sin(dec)], axis=-1)


def noise(points, seed):
    """Value noise in [0, 1] on a lattice of unit cells; the corners come from an integer hash."""
    cell = numpy.floor(points).astype(numpy.int64)
    part = points - cell
    part = part * part * (3.0 - 2.0 * part)
    total = numpy.zeros(points.shape[:-1])
    for corner in numpy.ndindex(2, 2, 2):
        x, y, z = (((cell[..., axis] + corner[axis]) & 0xFFFFFFFF).astype(numpy.uint64) for axis in range(3))
        mixed = (x * 73856093) ^ (y * 19349663) ^ (z * 83492791) ^ numpy.uint64(seed * 2654435761)
        mixed = ((mixed ^ (mixed >> numpy.uint64(16))) * numpy.uint64(0x45D9F3B)) & numpy.uint64(0xFFFFFFFF)
        mixed = ((mixed ^ (mixed >> numpy.uint64(16))) * numpy.uint64(0x45D9F3B)) & numpy.uint64(0xFFFFFFFF)
        value = (mixed ^ (mixed >> numpy.uint64(16))).astype(float) / 2**32
        weight = numpy.prod([part[..., axis] if corner[axis] else 1.0 - part[..., axis] for axis in range(3)], axis=0)
        total += weight * value
    return total


def make_milky_way(source, target):
    features = json.loads(source.read_text())["features"]
    contours = {feature["id"]: feature["geometry"]["coordinates"] for feature in features}
    brightness = numpy.zeros((HEIGHT, WIDTH))
    for name, (share, degrees) in LEVELS.items():
        brightness += share * blur(inside(contours[name]), degrees)

    # North galactic pole and galactic centre, ICRS: Hipparcos catalogue, volume 1, section 1.5.3.
    pole = numpy.radians([192.85948, 27.12825])
    centre = numpy.radians([266.40499, -28.93617])
    unit = lambda place: numpy.array([numpy.cos(place[1]) * numpy.cos(place[0]), numpy.cos(place[1]) * numpy.sin(place[0]), numpy.sin(place[1])])
    view = directions()
    latitude = numpy.degrees(numpy.arcsin(numpy.clip(view @ unit(pole), -1, 1)))
    from_centre = numpy.degrees(numpy.arccos(numpy.clip(view @ unit(centre), -1, 1)))
    # The contours say how bright the eye finds it; the true light rises more steeply to the plane and the bulge.
    brightness *= 0.55 + 0.45 * numpy.exp(-numpy.abs(latitude) / 7.0)
    brightness *= 0.8 + 0.7 * numpy.exp(-((from_centre / 45.0) ** 2)) + 0.4 * numpy.exp(-((from_centre / 14.0) ** 2))
    # A veil from the disk's stars everywhere, and clouds finer than the contours.
    brightness += 0.012 * numpy.exp(-numpy.abs(latitude) / 20.0) + 0.004
    clouds = sum(noise(view * 11.0 * 2**octave + 100.0, octave) * 0.6**octave for octave in range(5)) / 2.3056
    brightness *= 0.25 + 1.5 * clouds
    brightness /= numpy.percentile(brightness, 99.95)

    grey = numpy.clip(numpy.round(255.0 * numpy.sqrt(brightness)), 0, 255).astype(numpy.uint8)
    write_png(target, grey)
    print(f"{target.name}: {WIDTH} x {HEIGHT}, {target.stat().st_size} bytes")


def write_png(target, grey):
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    # Filter 1: each byte less its left neighbour.
    rows = numpy.concatenate([grey[:, :1], numpy.diff(grey, axis=1)], axis=1).astype(numpy.uint8)
    data = b"".join(b"\x01" + row.tobytes() for row in rows)
    header = struct.pack(">IIBBBBB", grey.shape[1], grey.shape[0], 8, 0, 0, 0, 0)
    target.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b""))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    make_stars(Path(sys.argv[1]) / "hipparcos2.csv.gz", HERE / "stars.bin")
    make_milky_way(Path(sys.argv[1]) / "milky-way.geojson", HERE / "milky-way.png")
