"""Models the two ships and writes hunter.glb and quarry.glb beside this script.

    blender -b -P make_ships.py [-- FOLDER]     with FOLDER: previews of both ships go there as PNG

Blender 3.4 or later. In Blender the nose points along +y and up is +z, which glTF turns into -z and +y. Each ship is built from a
few kinds of parts (lofted hulls, wings, lathed engines, bevelled boxes), joined, and scaled to length 1 about its middle.
"""

import math
import random
import sys
from pathlib import Path

import bmesh
import bpy
from mathutils import Euler, Vector

HERE = Path(__file__).resolve().parent


class Palette:
    """The materials of one ship by name; a part names the material of its faces."""

    def __init__(self, **colours):
        self.names = list(colours)
        self.materials = [self.make(name, **look) for name, look in colours.items()]

    @staticmethod
    def make(name, colour, metallic=0.0, roughness=0.5, glow=0.0):
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        material.diffuse_color = (*colour, 1.0)
        shader = material.node_tree.nodes["Principled BSDF"]
        shader.inputs["Base Color"].default_value = (*colour, 1.0)
        shader.inputs["Metallic"].default_value = metallic
        shader.inputs["Roughness"].default_value = roughness
        if glow:
            shader.inputs["Emission"].default_value = (*colour, 1.0)
            shader.inputs["Emission Strength"].default_value = glow
        return material

    def index(self, name):
        return self.names.index(name)


class Ship:
    """Collects parts as objects and joins them."""

    def __init__(self, name, palette):
        self.name, self.palette, self.parts = name, palette, []

    def lot(self, face):
        """A number in [0, 1) drawn by the place of a face, the same on both sides of the ship."""
        x, y, z = face.calc_center_median()
        return random.Random(f"{self.name} {abs(x):.2f} {y:.2f} {z:.2f}").random()

    def add(self, mesh, bevel=0.0, segments=1):
        bmesh.ops.recalc_face_normals(mesh, faces=mesh.faces)
        if bevel:
            sharp = [edge for edge in mesh.edges if edge.is_manifold and edge.calc_face_angle(0.0) > math.radians(40)]
            bmesh.ops.bevel(mesh, geom=sharp, offset=bevel, segments=segments, affect="EDGES", profile=0.7, clamp_overlap=True)
        data = bpy.data.meshes.new(self.name)
        mesh.to_mesh(data)
        mesh.free()
        part = bpy.data.objects.new(self.name, data)
        for material in self.palette.materials:
            data.materials.append(material)
        bpy.context.collection.objects.link(part)
        self.parts.append(part)

    def rings(self, rings, material, close=True, bevel=0.0, panels=None, stripes=None):
        """A skin over rings of equally many points. `panels` = (material, share, inset, depth) insets some of the faces;
        `stripes` maps the number of a band of faces (along the rings) to a material."""
        mesh = bmesh.new()
        loops = [[mesh.verts.new(point) for point in ring] for ring in rings]
        faces = []
        for band, (near, far) in enumerate(zip(loops, loops[1:])):
            for index in range(len(near)):
                after = (index + 1) % len(near)
                corners = list(dict.fromkeys([near[index], near[after], far[after], far[index]]))
                face = mesh.faces.new(corners)
                name = stripes[band] if stripes and band in stripes else material
                face.material_index = self.palette.index(name)
                faces.append(face)
        if close:
            for loop in (loops[0], loops[-1]):
                cap = mesh.faces.new(loop)
                cap.material_index = self.palette.index(material)
        bmesh.ops.recalc_face_normals(mesh, faces=mesh.faces)
        if panels:
            name, share, inset, depth = panels
            plain = self.palette.index(material)
            chosen = [face for face in faces if face.material_index == plain and self.lot(face) < share]
            # The new faces around an inset keep the material; the face itself becomes the panel.
            bmesh.ops.inset_individual(mesh, faces=chosen, thickness=inset, depth=depth, use_even_offset=True)
            for face in chosen:
                face.material_index = self.palette.index(name)
        self.add(mesh, bevel)

    def hull(self, sections, material, points=16, **options):
        """Superelliptic sections (y, half width, half height, z of the middle, exponent) from tail to nose."""
        rings = []
        for y, width, height, middle, exponent in sections:
            ring = []
            for step in range(points):
                angle = 2 * math.pi * (step + 0.5) / points
                cosine, sine = math.cos(angle), math.sin(angle)
                x = width * math.copysign(abs(cosine) ** (2 / exponent), cosine)
                z = height * math.copysign(abs(sine) ** (2 / exponent), sine)
                ring.append(Vector((x, y, middle + z)))
            rings.append(ring)
        self.rings(rings, material, **options)

    def wing(self, sections, material, side, **options):
        """Six-sided aerofoils (x, leading y, trailing y, z, thickness) from root to tip, on one side (1 right, -1 left)."""
        rings = []
        for x, lead, trail, z, thick in sections:
            chord = lead - trail
            ring = [(lead, 0), (lead - 0.22 * chord, 0.5), (trail + 0.3 * chord, 0.42), (trail, 0.05), (trail + 0.3 * chord, -0.42), (lead - 0.22 * chord, -0.5)]
            rings.append([Vector((side * x, y, z + t * thick)) for y, t in ring])
        self.rings(rings, material, **options)

    def lathe(self, centre, profile, points=20, squash=1.0):
        """A solid of revolution about y: profile of (y, radius, material of the band that begins there)."""
        mesh = bmesh.new()
        loops = []
        for y, radius, _ in profile:
            ring = []
            for step in range(points):
                angle = 2 * math.pi * step / points
                ring.append(mesh.verts.new(Vector(centre) + Vector((radius * math.cos(angle), y, squash * radius * math.sin(angle)))))
            loops.append(ring)
        for (near, far), (_, _, material) in zip(zip(loops, loops[1:]), profile):
            for index in range(points):
                after = (index + 1) % points
                face = mesh.faces.new([near[index], near[after], far[after], far[index]])
                face.material_index = self.palette.index(material)
        for loop, (_, _, material) in ((loops[0], profile[0]), (loops[-1], profile[-1])):
            cap = mesh.faces.new(loop)
            cap.material_index = self.palette.index(material)
        self.add(mesh)

    def box(self, centre, size, material, bevel=0.0, turn=(0, 0, 0), taper=1.0):
        """A box, its +y end scaled by `taper`, turned by Euler angles in degrees."""
        mesh = bmesh.new()
        bmesh.ops.create_cube(mesh, size=1.0)
        rotation = Euler([math.radians(angle) for angle in turn]).to_matrix()
        for vertex in mesh.verts:
            scale = taper if vertex.co.y > 0 else 1.0
            local = Vector((vertex.co.x * size[0] * scale, vertex.co.y * size[1], vertex.co.z * size[2] * scale))
            vertex.co = Vector(centre) + rotation @ local
        for face in mesh.faces:
            face.material_index = self.palette.index(material)
        self.add(mesh, bevel)

    def ball(self, centre, size, material, divisions=2):
        mesh = bmesh.new()
        bmesh.ops.create_icosphere(mesh, subdivisions=divisions, radius=1.0)
        for vertex in mesh.verts:
            vertex.co = Vector(centre) + Vector(component * scale for component, scale in zip(vertex.co, size))
        for face in mesh.faces:
            face.material_index = self.palette.index(material)
        self.add(mesh)

    def finish(self):
        """Joins the parts, scales the ship to length 1 about its middle, and makes normals sharp at angles over 35 degrees."""
        bpy.ops.object.select_all(action="DESELECT")
        for part in self.parts:
            part.select_set(True)
        bpy.context.view_layer.objects.active = self.parts[0]
        bpy.ops.object.join()
        ship = bpy.context.view_layer.objects.active
        low = [min(vertex.co[axis] for vertex in ship.data.vertices) for axis in range(3)]
        high = [max(vertex.co[axis] for vertex in ship.data.vertices) for axis in range(3)]
        scale = 1.0 / (high[1] - low[1])
        middle = Vector((0.0, (high[1] + low[1]) / 2, (high[2] + low[2]) / 2))
        for vertex in ship.data.vertices:
            vertex.co = (vertex.co - middle) * scale
        ship.data.polygons.foreach_set("use_smooth", [True] * len(ship.data.polygons))
        ship.data.use_auto_smooth = True
        ship.data.auto_smooth_angle = math.radians(35)
        ship.data.calc_loop_triangles()
        print(f"{self.name}: {len(ship.data.loop_triangles)} triangles")
        return ship


def hunter():
    """A long white interceptor: needle nose, cranked delta wings, twin engines with blue light, canopy far forward."""
    ship = Ship("hunter", Palette(
        hull=dict(colour=(0.74, 0.76, 0.80), metallic=0.2, roughness=0.38),
        plate=dict(colour=(0.42, 0.45, 0.51), metallic=0.35, roughness=0.45),
        dark=dict(colour=(0.045, 0.05, 0.06), metallic=0.6, roughness=0.4),
        accent=dict(colour=(0.03, 0.19, 0.62), metallic=0.1, roughness=0.35),
        glass=dict(colour=(0.02, 0.035, 0.05), metallic=0.9, roughness=0.06),
        drive=dict(colour=(0.25, 0.62, 1.0), glow=9.0),
        lamp=dict(colour=(0.9, 0.97, 1.0), glow=5.0),
        port=dict(colour=(1.0, 0.08, 0.05), glow=5.0),
        starboard=dict(colour=(0.08, 1.0, 0.25), glow=5.0),
    ))
    ship.hull(
        [
            (-4.3, 0.55, 0.42, 0.02, 3.2), (-3.9, 0.78, 0.52, 0.02, 3.0), (-3.0, 0.86, 0.58, 0.02, 2.8), (-2.0, 0.84, 0.60, 0.02, 2.6),
            (-1.0, 0.76, 0.58, 0.02, 2.5), (0.0, 0.68, 0.54, 0.01, 2.4), (1.0, 0.60, 0.48, -0.01, 2.3), (2.0, 0.50, 0.41, -0.04, 2.2),
            (2.9, 0.39, 0.32, -0.08, 2.1), (3.7, 0.27, 0.22, -0.12, 2.0), (4.4, 0.15, 0.12, -0.15, 2.0), (4.95, 0.05, 0.04, -0.165, 2.0),
        ],
        "hull", points=20, panels=("plate", 0.30, 0.022, -0.014), stripes={9: "accent", 4: "plate"})
    # Spine from canopy to tail.
    ship.hull([(-4.4, 0.20, 0.14, 0.52, 2.6), (-3.2, 0.27, 0.22, 0.58, 2.6), (-1.4, 0.28, 0.24, 0.58, 2.5), (0.2, 0.26, 0.22, 0.50, 2.3), (1.0, 0.18, 0.12, 0.44, 2.0)],
              "plate", points=12, panels=("dark", 0.25, 0.02, -0.012))
    # Canopy in its frame.
    ship.hull([(0.35, 0.12, 0.08, 0.46, 2.0), (0.8, 0.29, 0.27, 0.44, 2.0), (1.4, 0.335, 0.33, 0.38, 2.0), (2.1, 0.29, 0.27, 0.28, 2.0), (2.75, 0.16, 0.13, 0.16, 2.0), (3.05, 0.03, 0.03, 0.10, 2.0)],
              "glass", points=16)
    for y, width, height, z in ((0.85, 0.315, 0.29, 0.435), (1.75, 0.335, 0.315, 0.33)):
        ship.hull([(y - 0.04, width, height, z + 0.008, 2.0), (y + 0.04, width, height, z, 2.0)], "hull", points=16)
    for side in (1, -1):
        # Cranked delta: long strake, wide outer panel, tip bent down.
        ship.wing([(0.55, 2.1, -3.6, -0.06, 0.30), (1.05, 0.75, -3.75, -0.08, 0.24), (1.55, -0.55, -3.9, -0.10, 0.20), (2.5, -1.75, -4.05, -0.16, 0.14), (3.3, -2.75, -4.2, -0.21, 0.09), (3.65, -3.35, -4.25, -0.30, 0.05)],
                  "hull", side, panels=("plate", 0.45, 0.035, -0.012), stripes={3: "accent"})
        # Flaps along the trailing edge, one seam apart from the wing.
        ship.box((side * 1.62, -4.02, -0.10), (1.0, 0.30, 0.07), "dark", bevel=0.02, turn=(0, 0, side * -8))
        ship.box((side * 2.75, -4.20, -0.175), (0.95, 0.22, 0.05), "plate", bevel=0.015, turn=(0, side * 3, side * -8))
        # Guns under the strake and their muzzles.
        ship.lathe((side * 1.18, 0.0, -0.24), [(-0.9, 0.05, "plate"), (-0.8, 0.11, "plate"), (0.3, 0.11, "plate"), (0.45, 0.07, "dark"), (1.7, 0.055, "dark"), (1.72, 0.075, "dark"), (2.0, 0.075, "dark"), (2.0, 0.045, "dark"), (1.9, 0.03, "lamp")], points=10)
        # Intakes: bevelled boxes with a dark mouth, running back into the engines.
        intake(ship, side)
        # Engine: cowl, lip, nozzle petals, glowing throat.
        ship.lathe((side * 0.72, 0.0, 0.04), [
            (-2.6, 0.34, "plate"), (-2.7, 0.46, "hull"), (-3.7, 0.50, "dark"), (-3.8, 0.47, "hull"), (-4.25, 0.47, "dark"), (-4.3, 0.50, "dark"),
            (-4.45, 0.50, "dark"), (-4.95, 0.38, "dark"), (-4.95, 0.33, "dark"), (-4.55, 0.36, "drive"), (-4.5, 0.2, "drive")], points=24)
        ship.lathe((side * 0.72, 0.0, 0.04), [(-4.5, 0.17, "dark"), (-4.85, 0.03, "dark")], points=12)
        # Fins, canted outwards.
        fin = [(0.0, -2.5, -4.35, 0.0, 0.13), (0.55, -3.2, -4.55, 0.0, 0.10), (1.15, -3.95, -4.8, 0.0, 0.06)]
        rings = []
        for height, lead, trail, _, thick in fin:
            chord = lead - trail
            ring = [(lead, 0), (lead - 0.25 * chord, 0.5), (trail + 0.25 * chord, 0.45), (trail, 0), (trail + 0.25 * chord, -0.45), (lead - 0.25 * chord, -0.5)]
            cant = math.radians(24)
            rings.append([Vector((side * (0.82 + height * math.sin(cant) + t * thick * math.cos(cant)), y, 0.42 + height * math.cos(cant) - t * thick * math.sin(cant))) for y, t in ring])
        ship.rings(rings, "hull", stripes={1: "accent"}, panels=("plate", 0.4, 0.03, -0.008))
        # Wing-tip rail with its light.
        rail(ship, side)
        ship.ball((side * 3.66, -2.52, -0.30), (0.05, 0.12, 0.05), "starboard" if side > 0 else "port", 1)
        # Light strips along the flank.
        ship.box((side * 0.655, 0.55, 0.10), (0.03, 0.9, 0.035), "lamp", turn=(0, 0, side * 4.5))
    ship.box((0.0, -4.42, 0.52), (0.16, 0.10, 0.10), "lamp", bevel=0.02)
    for x in (-0.06, 0.06):
        ship.box((x, 4.85, -0.16), (0.02, 0.9, 0.02), "dark")
    ship.box((0.0, -1.9, -0.62), (0.5, 2.6, 0.14), "dark", bevel=0.05, taper=0.6)
    ship.box((0.0, 1.6, -0.50), (0.05, 0.5, 0.22), "plate", bevel=0.015)
    return ship.finish()


def shifted(ship, side, x, z, sections, material, points, **options):
    """A hull whose sections (y, half width, half height, exponent) are centred on (x, z), on one side."""
    rings = []
    for y, width, height, exponent in sections:
        ring = []
        for step in range(points):
            angle = 2 * math.pi * (step + 0.5) / points
            cosine, sine = math.cos(angle), math.sin(angle)
            ring.append(Vector((
                side * x + width * math.copysign(abs(cosine) ** (2 / exponent), cosine), y,
                z + height * math.copysign(abs(sine) ** (2 / exponent), sine))))
        rings.append(ring)
    ship.rings(rings, material, **options)


def smooth_path(path, parts):
    """The path with each leg split into `parts` along a Catmull-Rom spline."""
    points = [Vector(point) for point in path]
    fine = []
    for index in range(len(points) - 1):
        a, b, c, d = (points[max(0, min(len(points) - 1, index + step))] for step in (-1, 0, 1, 2))
        for part in range(parts):
            t = part / parts
            fine.append(tuple(b + 0.5 * (t * (c - a) + t * t * (2 * a - 5 * b + 4 * c - d) + t ** 3 * (3 * b - a - 3 * c + d))))
    return fine + [tuple(points[-1])]


def intake(ship, side):
    shifted(ship, side, 0.74, 0.0, [(-3.2, 0.42, 0.44, 2.6), (-2.2, 0.43, 0.44, 3.2), (-0.8, 0.36, 0.38, 4.0), (0.15, 0.27, 0.29, 5.0), (0.22, 0.22, 0.24, 5.0), (-0.35, 0.19, 0.21, 5.0)],
            "plate", 16, stripes={3: "hull", 4: "dark"}, panels=("dark", 0.12, 0.03, -0.015))


def rail(ship, side):
    shifted(ship, side, 3.66, -0.30, [(-4.45, 0.02, 0.02, 2), (-4.2, 0.065, 0.065, 2), (-2.9, 0.065, 0.065, 2), (-2.45, 0.02, 0.02, 2)], "dark", 8)


def quarry():
    """A broad dark-red raider: round hull between two forward claws, a ring keel, three engines with amber light."""
    ship = Ship("quarry", Palette(
        hull=dict(colour=(0.36, 0.035, 0.025), metallic=0.35, roughness=0.36),
        plate=dict(colour=(0.13, 0.02, 0.018), metallic=0.45, roughness=0.42),
        dark=dict(colour=(0.03, 0.028, 0.03), metallic=0.7, roughness=0.38),
        bronze=dict(colour=(0.55, 0.31, 0.10), metallic=0.9, roughness=0.32),
        glass=dict(colour=(0.03, 0.02, 0.012), metallic=0.9, roughness=0.07),
        drive=dict(colour=(1.0, 0.42, 0.08), glow=9.0),
        lamp=dict(colour=(1.0, 0.75, 0.35), glow=5.0),
        eye=dict(colour=(1.0, 0.12, 0.02), glow=7.0),
    ))
    # Body: a flattened teardrop.
    ship.hull(
        [
            (-2.6, 0.55, 0.35, 0.05, 2.4), (-2.2, 0.95, 0.55, 0.05, 2.3), (-1.5, 1.25, 0.72, 0.05, 2.2), (-0.7, 1.36, 0.78, 0.04, 2.1), (0.1, 1.30, 0.74, 0.02, 2.1),
            (0.8, 1.10, 0.64, 0.0, 2.1), (1.4, 0.84, 0.50, -0.02, 2.1), (1.9, 0.54, 0.34, -0.04, 2.0), (2.2, 0.26, 0.18, -0.05, 2.0),
        ],
        "hull", points=24, panels=("plate", 0.38, 0.03, -0.02), stripes={0: "dark", 7: "bronze"})
    # The eye: sensor in the bow.
    ship.lathe((0.0, 0.0, -0.05), [(2.1, 0.25, "dark"), (2.32, 0.24, "dark"), (2.36, 0.20, "dark"), (2.28, 0.16, "eye"), (2.34, 0.08, "eye")], points=18)
    # Canopy, set back, with bronze ribs.
    ship.hull([(-1.2, 0.10, 0.06, 0.78, 2.0), (-0.8, 0.36, 0.24, 0.78, 2.0), (-0.2, 0.46, 0.34, 0.72, 2.0), (0.45, 0.40, 0.29, 0.60, 2.0), (1.0, 0.20, 0.13, 0.47, 2.0), (1.2, 0.05, 0.03, 0.42, 2.0)],
              "glass", points=16)
    for y, width, height, z in ((-0.75, 0.385, 0.265, 0.777), (-0.1, 0.47, 0.35, 0.70), (0.5, 0.40, 0.285, 0.588)):
        ship.hull([(y - 0.04, width, height, z + 0.008, 2.0), (y + 0.04, width, height, z, 2.0)], "bronze", points=16)
    for side in (1, -1):
        # Shoulder: joins hull and claw.
        ship.wing([(0.85, 0.9, -1.7, 0.02, 0.62), (1.6, 0.75, -1.75, 0.0, 0.50), (2.3, 0.75, -1.55, -0.03, 0.44), (2.75, 0.85, -1.2, -0.06, 0.40)],
                  "plate", side, panels=("dark", 0.35, 0.05, -0.02))
        # Claw: a blade that sweeps forward and bends inward, thick at the shoulder.
        path = [(2.15, -2.35, 0.10, 0.07), (2.55, -1.75, 0.26, 0.17), (2.85, -0.9, 0.36, 0.26), (2.95, 0.0, 0.38, 0.28), (2.87, 0.9, 0.34, 0.25), (2.62, 1.75, 0.27, 0.20), (2.24, 2.5, 0.18, 0.13), (1.78, 3.1, 0.09, 0.07), (1.45, 3.4, 0.015, 0.015)]
        path = smooth_path(path, 3)
        rings = []
        for x, y, width, height in path:
            section = [(1.0, 0.0), (0.55, 0.85), (-0.35, 1.0), (-0.95, 0.35), (-0.95, -0.35), (-0.35, -1.0), (0.55, -0.85)]
            rings.append([Vector((side * (x + width * a), y, -0.06 + height * b)) for a, b in section])
        ship.rings(rings, "hull", panels=("plate", 0.35, 0.018, -0.014), stripes={15: "bronze", 16: "bronze", 21: "dark", 22: "dark", 23: "dark"})
        # Inner edge of the claw: a glowing slit.
        for (x, y, width, _), (x2, y2, width2, _) in zip(path[9:18:3], path[12:21:3]):
            inner, inner2 = x - 0.97 * width, x2 - 0.97 * width2
            length = math.hypot(inner2 - inner, y2 - y)
            angle = math.degrees(math.atan2(-(inner2 - inner), y2 - y)) * side
            ship.box((side * (inner + inner2) / 2, (y + y2) / 2, -0.06), (0.05, 0.86 * length, 0.055), "lamp", turn=(0, 0, angle))
        # Engines at the shoulders.
        ship.lathe((side * 1.72, 0.0, 0.0), [
            (-0.9, 0.18, "bronze"), (-1.1, 0.40, "plate"), (-2.1, 0.46, "bronze"), (-2.2, 0.48, "bronze"), (-2.35, 0.48, "dark"), (-2.4, 0.43, "dark"),
            (-2.95, 0.50, "dark"), (-2.95, 0.44, "dark"), (-2.55, 0.33, "drive"), (-2.5, 0.15, "drive")], points=22)
        # Vanes above and below each engine.
        for up in (1, -1):
            fin = [(0.30, -1.2, -2.6, 0.10), (0.85, -1.9, -3.0, 0.07), (1.25, -2.65, -3.35, 0.035)]
            rings = []
            for height, lead, trail, thick in fin:
                chord = lead - trail
                ring = [(lead, 0), (lead - 0.3 * chord, 0.5), (trail + 0.2 * chord, 0.4), (trail, 0), (trail + 0.2 * chord, -0.4), (lead - 0.3 * chord, -0.5)]
                lean = math.radians(32)
                rings.append([Vector((side * (1.72 + height * math.sin(lean) + t * thick), y, up * height * math.cos(lean))) for y, t in ring])
            ship.rings(rings, "hull" if up > 0 else "plate", stripes={1: "bronze"})
        ship.ball((side * 3.28, 0.05, -0.06), (0.06, 0.16, 0.06), "eye", 1)
        # Struts from the body to the claw's forearm.
        ship.box((side * 1.72, 1.02, -0.05), (1.75, 0.16, 0.13), "bronze", bevel=0.03, turn=(0, 0, side * 14))
        ship.box((side * 0.62, -0.2, -0.70), (0.22, 1.5, 0.16), "dark", bevel=0.04, taper=0.6, turn=(0, side * -24, 0))
    # Middle engine, larger.
    ship.lathe((0.0, 0.0, 0.05), [
        (-2.3, 0.50, "bronze"), (-2.55, 0.58, "bronze"), (-2.7, 0.58, "dark"), (-2.75, 0.50, "dark"), (-3.4, 0.62, "dark"), (-3.4, 0.54, "dark"), (-2.95, 0.40, "drive"), (-2.9, 0.2, "drive")], points=26)
    # Dorsal ridge of three blades.
    for index, (y, height) in enumerate(((-1.35, 0.50), (-1.75, 0.42), (-2.12, 0.33))):
        ship.box((0.0, y, 0.72 + 0.28 * height - 0.12 * index), (0.06, 0.42, height), "bronze", bevel=0.015, turn=(28, 0, 0))
    # Keel lights.
    for y in (-0.9, -0.3, 0.3, 0.9):
        ship.box((0.0, y, -0.735 + 0.10 * max(y, 0) ** 2 + 0.03 * abs(y)), (0.22, 0.08, 0.06), "lamp", bevel=0.015)
    return ship.finish()


def export(ship):
    bpy.ops.object.select_all(action="DESELECT")
    ship.select_set(True)
    bpy.ops.export_scene.gltf(
        filepath=str(HERE / f"{ship.name.split('.')[0]}.glb"), export_format="GLB", use_selection=True, export_yup=True, export_apply=False,
        export_texcoords=False, export_normals=True, export_materials="EXPORT", export_animations=False, export_cameras=False, export_lights=False)


def preview(ship, folder):
    """Three views with the path tracer, on the processor."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 32
    scene.cycles.use_denoising = False
    scene.render.resolution_x, scene.render.resolution_y = 640, 400
    scene.view_settings.view_transform = "Filmic"
    world = bpy.data.worlds.new("space")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs[0].default_value = (0.05, 0.06, 0.09, 1.0)
    scene.world = world
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy = 4.0
    sun.rotation_euler = Euler((math.radians(40), math.radians(20), math.radians(30)))
    scene.collection.objects.link(sun)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.lens = 50
    scene.collection.objects.link(camera)
    scene.camera = camera
    name = ship.name.split(".")[0]
    for view, place in (("front", (0.9, 1.15, 0.55)), ("rear", (-0.75, -1.25, 0.5)), ("top", (0.01, 0.05, 1.75)), ("below", (1.0, 0.6, -1.0))):
        camera.location = Vector(place)
        camera.rotation_euler = (-Vector(place)).to_track_quat("-Z", "Y").to_euler()
        scene.render.filepath = str(Path(folder) / f"{name}-{view}.png")
        bpy.ops.render.render(write_still=True)


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    for build in (hunter, quarry):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        ship = build()
        export(ship)
        if arguments:
            preview(ship, arguments[0])


main()
