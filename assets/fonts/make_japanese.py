"""Makes japanese.otf, the letters of the Japanese words: Noto Sans CJK JP, cut down to the characters that the game writes.

    python3 make_japanese.py NotoSansCJK-Regular.ttc        (needs fonttools: pip install fonttools)

The source font is in Debian's package fonts-noto-cjk (/usr/share/fonts/opentype/noto/NotoSansCJK-Regular.ttc; this file was made from
version 1:20220127) and at https://github.com/notofonts/noto-cjk. Run it again whenever a text of ../words/ or ../missions/ changes; the
test `every_letter_of_the_words_is_in_the_font` says when that was forgotten. The same input gives the same bytes.

Kept are every character of ../words/*.ftl and ../missions/*.toml that the font has, ASCII, kana and full-width punctuation.
"""

import sys
from pathlib import Path

from fontTools.subset import Options, Subsetter
from fontTools.ttLib import TTCollection, TTFont

HERE = Path(__file__).resolve().parent
ASSETS = HERE.parent
# The family's name; "Source" is reserved by the licence, and a cut font is not the original.
NAME = "Lensrunner Japanese"
# Nameplate entries that stay: copyright, trademark, licence and its address. The others are written anew.
KEPT_NAMES = {0, 7, 13, 14}
# Always there, so that a new text seldom needs a new font: ASCII, ideographic punctuation, kana, full-width forms.
RANGES = [(0x20, 0x7E), (0x3000, 0x303F), (0x3041, 0x3096), (0x3099, 0x30FF), (0xFF01, 0xFF60)]

# What the program itself writes beside the words.
SIGNS = "←↑→↓★☆‹›±°×·–—…²³"


def characters():
    """Every character of the words and of the missions, and the ranges above."""
    found = {chr(code) for first, last in RANGES for code in range(first, last + 1)} | set(SIGNS)
    for file in [*sorted((ASSETS / "words").glob("*.ftl")), *sorted((ASSETS / "missions").glob("*.toml"))]:
        found.update(file.read_text(encoding="utf-8"))
    return {c for c in found if c.isprintable()}


def source(path):
    """The Japanese font of a collection, or the only font of a file."""
    if path.suffix != ".ttc":
        return TTFont(path, recalcTimestamp=False)
    fonts = TTCollection(path).fonts
    japanese = [font for font in fonts if font["name"].getDebugName(1) == "Noto Sans CJK JP"]
    if not japanese:
        raise SystemExit(f"{path}: no Noto Sans CJK JP in this collection")
    japanese[0].recalcTimestamp = False
    return japanese[0]


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    font = source(Path(sys.argv[1]))
    wanted = characters()
    options = Options()
    options.hinting = False
    options.layout_features = []
    options.name_IDs = sorted(KEPT_NAMES)
    options.drop_tables += ["BASE", "GPOS", "GSUB", "VORG", "vhea", "vmtx"]
    options.glyph_names = False
    subsetter = Subsetter(options)
    subsetter.populate(unicodes={ord(c) for c in wanted})
    subsetter.subset(font)
    names = font["name"]
    for record, text in [(1, NAME), (2, "Regular"), (3, NAME), (4, NAME), (6, NAME.replace(" ", ""))]:
        names.setName(text, record, 3, 1, 0x409)
    cff = font["CFF "].cff if "CFF " in font else None
    if cff:
        cff.fontNames = [NAME.replace(" ", "")]
        cff[0].FullName = cff[0].FamilyName = NAME
    target = HERE / "japanese.otf"
    font.save(target)
    missing = sorted(wanted - {chr(code) for code in font.getBestCmap()})
    ranges = {chr(code) for first, last in RANGES for code in range(first, last + 1)}
    print(f"{target.name}: {len(font.getBestCmap())} characters, {target.stat().st_size / 1024:.0f} KiB")
    print("not in the source font:", " ".join(c for c in missing if c not in ranges) or "none")


main()
