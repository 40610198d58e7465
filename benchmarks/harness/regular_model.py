"""A regular frame of another size, from one that ships."""

import json


def write(shipped, path, posts_x, posts_y, storeys):
    with open(shipped, encoding="utf-8") as stored:
        model = json.load(stored)
    model["title"] = "Regular frame, %d x %d posts, %d storeys" % (posts_x, posts_y, storeys)
    model["building"].update(posts=[posts_x, posts_y], storeys=storeys)
    with open(path, "w", encoding="utf-8") as out:
        json.dump(model, out, indent=1)
