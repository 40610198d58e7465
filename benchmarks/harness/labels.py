"""Labels of points in a figure with logarithmic axes, placed so that none covers another."""

import math

WIDTH, HEIGHT = 760.0, 400.0  # of the plot inside of its axes, in the units of the terminal
LETTER, LINE = 5.4, 11.0  # of a label in 8 point letters


def place(points, x_range, y_range):
    """`points`: (text, x, y). Returns (text, x, y, point's x, point's y) of left-aligned labels: beside its point, or above or below that
    as far as needed."""
    def across(x):
        return WIDTH * math.log(x / x_range[0]) / math.log(x_range[1] / x_range[0])

    def up(y):
        return HEIGHT * math.log(y / y_range[0]) / math.log(y_range[1] / y_range[0])

    marks = [(across(x), up(y)) for _, x, y in points]
    taken = [(px - 4, py - 4, px + 4, py + 4) for px, py in marks]
    placed = []
    for (text, point_x, point_y), (px, py) in sorted(zip(points, marks), key=lambda item: item[1]):
        width = LETTER * len(text)
        left = px + 7 if px + 7 + width < WIDTH else px - 7 - width
        for step in range(60):
            rise = (step + 1) // 2 * LINE * 0.5 * (1 if step % 2 else -1)
            box = (left, py + rise - LINE / 2, left + width, py + rise + LINE / 2)
            free = all(box[2] < b[0] or b[2] < box[0] or box[3] < b[1] or b[3] < box[1] for b in taken)
            if free and 0 < box[1] and box[3] < HEIGHT:
                break
        taken.append(box)
        x = x_range[0] * (x_range[1] / x_range[0]) ** (left / WIDTH)
        y = y_range[0] * (y_range[1] / y_range[0]) ** ((box[1] + box[3]) / 2 / HEIGHT)
        placed.append((text, x, y, point_x, point_y))
    return placed


def decades(values, below=1.0, above=1.0):
    """A range of whole decades that holds the values with room to spare."""
    return (10.0 ** (math.floor(math.log10(min(values))) - below + 1), 10.0 ** (math.ceil(math.log10(max(values))) + above - 1))
