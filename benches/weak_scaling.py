#!/usr/bin/env python3
"""Predict a run whose ranks are many and full, from the counts of a partition of a smaller mesh.

    zelus partition DECK -n 1000 --json cut.json
    weak_scaling.py cut.json [--elements 20000]

The partition gives neighbours and surfaces per rank for its number of ranks; surfaces are scaled to --elements a rank
with the power 2/3, neighbours are kept. Each line of the table is a formula, its count and its seconds. Costs of the
machine and of the kernels are options; their defaults are said in docs/weak_scaling.md.
"""
import argparse
import json
import math


def counted(path):
    """Ranks, and mean and largest of each count."""
    with open(path) as file:
        document = json.load(file)
    ranks = document["counts"]["ranks"]
    mean = {key: sum(rank[key] for rank in ranks) / len(ranks) for key in ranks[0]}
    most = {key: max(rank[key] for rank in ranks) for key in ranks[0]}
    return document["ranks"], mean, most, document["counts"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cut", metavar="CUT", help="JSON file of zelus partition")
    parser.add_argument("--elements", type=float, default=20000, help="elements a rank")
    parser.add_argument("--newton", type=int, default=5, help="Newton iterations a step")
    parser.add_argument("--krylov", type=int, default=20, help="Krylov iterations a solve")
    parser.add_argument("--products", type=int, default=6, help="products of the matrix in a Krylov iteration")
    parser.add_argument("--element", type=float, default=16e-6, help="seconds for the tangent of an element")
    parser.add_argument("--facet", type=float, default=72e-6, help="seconds for the pairs of a slave facet")
    parser.add_argument("--decide", type=float, default=5e-6, 
                        help="seconds a slave facet of all ranks for active set and search, which every rank computes")
    parser.add_argument("--memory", type=float, default=5e9, help="bytes a second that a rank reads from memory")
    parser.add_argument("--latency", type=float, default=2e-6, help="seconds a message")
    parser.add_argument("--network", type=float, default=1e9, help="bytes a second that a rank sends")
    options = parser.parse_args()

    ranks, mean, most, counts = counted(options.cut)
    d, newton, krylov, products = counts["unknowns_per_node"], options.newton, options.krylov, options.products
    nodes_each = mean["nodes"] / mean["elements"]
    entries_each = counts["entries"] / (ranks * mean["nodes"])
    grow = (options.elements / mean["elements"]) ** (2 / 3)
    nodes, imbalance = nodes_each * options.elements, counts["imbalance"]
    entries = d * d * entries_each * nodes
    ghosts, copies, rows = (grow * most[key] for key in ("ghosts", "copies", "ghost_entries"))
    neighbours, facets = most["neighbours"], grow * mean["slave_facets"]
    common, all_facets = grow * counts["common"], ranks * facets
    levels = math.ceil(math.log2(ranks)) if ranks > 1 else 0
    coarse = max(1, math.ceil(math.log(ranks * nodes * d / 1000) / math.log(20)))

    work = [
        ("tangents of elements", "m t_e", f"{options.elements:.0f} · {options.element:.2g}",
         options.elements * options.element),
        ("pairs of slave facets", "f t_f", f"{facets:.0f} · {options.facet:.2g}", facets * options.facet),
        ("products of the matrix", "12 z K S 4/3 / M", f"12 · {entries:.3g} · {krylov} · {products} · 1.33",
         12 * entries * krylov * products * 4 / 3 / options.memory),
        ("set-up of multigrid", "12 z 10 S 4/3 / M", f"12 · {entries:.3g} · 10 · {products} · 1.33",
         12 * entries * 10 * products * 4 / 3 / options.memory),
    ]
    talk = [
        ("active set and search, on every rank", "F t_d", f"{all_facets:.0f} · {options.decide:.2g}", all_facets * options.decide),
        ("values, residuals", "8 d (p + g) / B + 2 P a", f"8 · {d} · ({copies:.0f} + {ghosts:.0f}); 2 · {neighbours}",
         8 * d * (copies + ghosts) / options.network + 2 * neighbours * options.latency),
        ("values on all ranks", "8 d C / B + (N - 1) a", f"8 · {d} · {common:.0f}; {ranks - 1}",
         8 * d * common / options.network + (ranks - 1) * options.latency),
        ("interface", "(72 + 8 ⌈log₂ N⌉) F / B + (N - 1) a", f"(72 + 8 · {levels}) · {all_facets:.0f}; {ranks - 1}",
         (72 + 8 * levels) * all_facets / options.network + (ranks - 1) * options.latency),
        ("tangent rows of ghosts", "8 d² e / B + P a", f"8 · {d * d} · {rows:.0f}; {neighbours}",
         8 * d * d * rows / options.network + neighbours * options.latency),
        ("products: values", "K S (8 d p 4/3 / B + P L a)",
         f"{krylov} · {products} · (8 · {d} · {copies:.0f} · 1.33; {neighbours} · {coarse})",
         krylov * products * (8 * d * copies * 4 / 3 / options.network + neighbours * coarse * options.latency)),
        ("sums over all ranks", "(3 K + 4) 2 ⌈log₂ N⌉ a", f"{3 * krylov + 4} · 2 · {levels}",
         (3 * krylov + 4) * 2 * levels * options.latency),
    ]
    print(f"{ranks} ranks of {options.elements:.0f} elements: {ranks * nodes * d:.3g} unknowns, {nodes * d:.3g} a rank")
    print(f"\n| in one of {newton} Newton iterations | formula | count | seconds |\n|---|---|---|---|")
    for name, formula, count, seconds in work + talk:
        print(f"| {name} | {formula} | {count} | {seconds:.4f} |")
    alone = sum(line[3] for line in work)
    late, spoken = alone * (imbalance - 1), sum(line[3] for line in talk)
    print(f"| waiting for the fullest rank | (imbalance - 1) work | {imbalance - 1:.3f} · {alone:.3f} | {late:.4f} |")
    print(f"\na step: {newton * (alone + late + spoken):.2f} s on {ranks} ranks, {newton * alone:.2f} s on 1 with its share; "
          f"efficiency {alone / (alone + late + spoken):.2f}")
    print(f"nodes a rank has: {nodes:.0f} own, {ghosts:.0f} ghosts, {common:.0f} that all have; "
          f"{(nodes + ghosts + common) / 1e6:.2f} GB of mesh and fields at 1 kB a node")


if __name__ == "__main__":
    main()
