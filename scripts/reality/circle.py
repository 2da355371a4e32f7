"""A rigid circle that touches the front beam's outer side: a ring of elements whose
nodes all move as prescribed, and contact by a penalty between both surfaces."""

import math

PENALTY_N_MM3 = 50.0  # pressure over overclosure
SLIP_MM = 0.25  # along the beam in one increment, in which CalculiX keeps the contact's tangents
STICK = 10.0  # shear over slip, below the limit of friction, over the penalty


class Circle:
    def __init__(self, deck, radius_mm, centre, span_deg=50, step_mm=0.75):
        """Adds the ring, from -span to +span about +x, and both surfaces to the deck."""
        self.deck, self.radius_mm, self.centre, self.at = deck, radius_mm, centre, centre
        count = math.ceil(2 * math.radians(span_deg) * radius_mm / step_mm)
        first = len(deck.nodes)
        grid = {}
        for i in range(3):
            for j in range(2 * count + 1):
                if i == 1 and j % 2:
                    continue
                r = radius_mm - 1 + i / 2
                angle = math.radians(span_deg) * (j / count - 1)
                deck.nodes.append((centre[0] + r * math.cos(angle), centre[1] + r * math.sin(angle)))
                grid[i, j] = len(deck.nodes)
        elements = [(grid[0, j], grid[2, j], grid[2, j + 2], grid[0, j + 2],
                     grid[1, j], grid[2, j + 1], grid[1, j + 2], grid[0, j + 1])
                    for j in range(0, 2 * count, 2)]
        plant = deck.solid.plant
        deck.add("CIRCLE", elements, 2e5, plant.poisson, plant.width_mm)
        deck.lines.append("*NSET, NSET=RING, GENERATE")
        deck.lines.append(f"{first + 1},{len(deck.nodes)}")

    def contact(self, arc_from, arc_to, friction, penalty_N_mm3):
        deck = self.deck
        lines = ["*SURFACE, NAME=BEAM, TYPE=ELEMENT"]
        lines += [f"{deck.numbers['FRONT'][index]},S3" for index, (a, b) in deck.solid.outer
                  if a > arc_from - 1e-6 and b < arc_to + 1e-6]
        lines += ["*SURFACE, NAME=ROUND, TYPE=ELEMENT"]
        lines += [f"{n},S2" for n in deck.numbers["CIRCLE"]]
        lines += ["*SURFACE INTERACTION, NAME=TOUCH",
                  "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{penalty_N_mm3:.6g}"]
        if friction:
            lines += ["*FRICTION", f"{friction:.6g},{STICK * penalty_N_mm3:.6g}"]
        lines += ["*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "BEAM,ROUND"]
        deck.lines += lines

    def step(self, place, increment):
        """Moves the centre to this place, from where the last step left it. increment:
        the share of the way that CalculiX tries first."""
        along, self.at = abs(place[1] - self.at[1]), place
        most = min(1.0, SLIP_MM / along) if along else 1.0
        ux, uy = place[0] - self.centre[0], place[1] - self.centre[1]
        return ["*STEP, NLGEOM, INC=400", "*STATIC", f"{min(increment, most):.4g},1.,1e-5,{most:.4g}", "*BOUNDARY",
                f"RING,1,1,{ux:.12g}", f"RING,2,2,{uy:.12g}",
                "*NODE PRINT, NSET=ALL, FREQUENCY=1000", "U",
                "*CONTACT PRINT, SLAVE=BEAM, MASTER=ROUND, FREQUENCY=1000", "CF", "*END STEP"]
