//! `zelus partition`: the mesh of a deck cut for several ranks, and its costs.

use std::io::Write;
use std::path::PathBuf;

use serde_json::json;
use zelus_core::analysis::{DeckMesh, read_deck_mesh};
use zelus_core::io::results::{Cells, Column, Dataset, write_piece};
use zelus_core::io::{Mark, replace_own_file};
use zelus_core::model::ModelPart;
use zelus_core::partition::{Partition, PartitionCounts, RankCounts, Repeats, Traffic, partition};
use zelus_core::{Error, Result};

use super::report::check_output;
use super::say::say;

/// Up to this number of ranks every rank has its line.
const LINES: usize = 32;

/// The command line of `zelus partition`.
#[derive(Debug, clap::Args)]
pub(super) struct PartitionArguments {
    /// The deck, e.g. ProjectParameters.json.
    file: PathBuf,
    /// Number of ranks.
    #[arg(short = 'n', long = "ranks")]
    ranks: usize,
    /// Print a line for every rank, however many.
    #[arg(long)]
    all: bool,
    /// Newton iterations of a step, to estimate messages and bytes.
    #[arg(long, default_value_t = Repeats::default().newton)]
    newton: usize,
    /// Krylov iterations of a solve, to estimate messages and bytes.
    #[arg(long, default_value_t = Repeats::default().krylov)]
    krylov: usize,
    /// Write ranks of elements, conditions and nodes by id, and all counts, to this JSON file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Write the mesh with the rank of each element and owner of each node to this VTU file.
    #[arg(long)]
    vtu: Option<PathBuf>,
}

/// A key that every file of a partition has.
const MARK: Mark = Mark::Holds("\"repeats\"");

/// Cuts the mesh, prints the table and writes the files asked for.
pub(super) fn run(arguments: &PartitionArguments) -> Result<()> {
    for (what, path, mark) in
        [("partition", &arguments.json, MARK), ("picture", &arguments.vtu, Mark::Holds("<VTKFile"))]
    {
        let Some(path) = path else { continue };
        check_output(&format!("the {what}"), path, &[&arguments.file], mark)?;
    }
    let DeckMesh { part, surfaces, common } = read_deck_mesh(&arguments.file)?;
    let cut = partition(&part, &surfaces, arguments.ranks)?;
    let counts = PartitionCounts::new(&part, &cut, &common);
    let repeats = Repeats { newton: arguments.newton, krylov: arguments.krylov };
    say(explain(&part, &counts, repeats, arguments.all).trim_end());
    if let Some(path) = &arguments.json {
        let text = serde_json::to_string(&document(&part, &cut, &counts, repeats))
            .map_err(|error| Error::System(format!("partition: {error}")))?;
        replace_own_file(path, |file| file.write_all(text.as_bytes()))?;
        say(&format!("partition: {}", path.display()));
    }
    if let Some(path) = &arguments.vtu {
        write_piece(path, &picture(&part, &cut))?;
        say(&format!("picture: {}", path.display()));
    }
    Ok(())
}

/// A column of the table: its head and its number for a rank.
type OutputFrame = (&'static str, fn(&RankCounts, Traffic) -> usize);

const COLUMNS: [OutputFrame; 11] = [
    ("elements", |rank, _| rank.elements),
    ("nodes", |rank, _| rank.nodes),
    ("held", |rank, _| rank.held),
    ("ghosts", |rank, _| rank.ghosts),
    ("neighbours", |rank, _| rank.neighbours),
    ("cut faces", |rank, _| rank.cut_faces),
    ("facets", |rank, _| rank.facets),
    ("slaves", |rank, _| rank.slave_facets),
    ("far pairs", |rank, _| rank.far_pairs),
    ("messages", |_, traffic| traffic.messages),
    ("bytes", |_, traffic| traffic.bytes),
];

fn explain(part: &ModelPart, counts: &PartitionCounts, repeats: Repeats, all: bool) -> String {
    use std::fmt::Write as _;
    let ranks = counts.ranks.len();
    let mut text = format!(
        "{} elements, {} nodes, {} conditions on {ranks} ranks\n",
        part.elements.len(),
        part.nodes.len(),
        part.conditions.len()
    );
    let rows: Vec<Vec<usize>> = counts
        .ranks
        .iter()
        .enumerate()
        .map(|(at, rank)| {
            let traffic = counts.traffic(at, repeats);
            COLUMNS.iter().map(|(_, of)| of(rank, traffic)).collect()
        })
        .collect();
    let mut line = |head: &str, cells: Vec<String>| {
        let cells: Vec<String> = cells.iter().map(|cell| format!("{cell:>11}")).collect();
        let _ = writeln!(text, "{head:>7}{}", cells.concat());
    };
    line("rank", COLUMNS.iter().map(|(head, _)| (*head).to_owned()).collect());
    if all || ranks <= LINES {
        for (rank, row) in rows.iter().enumerate() {
            line(&rank.to_string(), row.iter().map(usize::to_string).collect());
        }
    }
    let columns = |of: &dyn Fn(&[usize]) -> String| -> Vec<String> {
        (0..COLUMNS.len()).map(|at| of(&rows.iter().map(|row| row[at]).collect::<Vec<_>>())).collect()
    };
    line("min", columns(&|values| values.iter().min().map_or(String::new(), usize::to_string)));
    line("mean", columns(&|values| format!("{:.1}", values.iter().sum::<usize>() as f64 / values.len() as f64)));
    line("max", columns(&|values| values.iter().max().map_or(String::new(), usize::to_string)));
    let all_bytes: usize = rows.iter().map(|row| row[COLUMNS.len() - 1]).sum();
    let _ = writeln!(
        text,
        "{} faces cut; imbalance {:.3} (largest load over mean load); {} nodes are on all ranks; {:.3} MB sent by all ranks a \
         step\n\
         messages and bytes sent a step: {} Newton iterations of one solve with {} Krylov iterations each, {} unknowns \
         a node",
        counts.cut,
        counts.imbalance,
        counts.common,
        all_bytes as f64 / 1e6,
        repeats.newton,
        repeats.krylov,
        counts.unknowns_per_node
    );
    text
}

fn document(part: &ModelPart, cut: &Partition, counts: &PartitionCounts, repeats: Repeats) -> serde_json::Value {
    let traffic: Vec<Traffic> = (0..counts.ranks.len()).map(|rank| counts.traffic(rank, repeats)).collect();
    json!({
        "ranks": cut.ranks,
        "elements": { "ids": part.elements.ids, "rank": cut.elements },
        "conditions": { "ids": part.conditions.ids, "rank": cut.conditions },
        "nodes": { "ids": part.nodes.ids, "owner": cut.nodes },
        "counts": counts,
        "repeats": repeats,
        "traffic": traffic,
    })
}

fn picture(part: &ModelPart, cut: &Partition) -> Dataset {
    let mut cells = Cells::default();
    let mut ranks = Vec::new();
    for element in 0..part.elements.len() {
        if let Some(shape) = part.elements.kinds[element].cell {
            let nodes = part.elements.nodes(element as u32).iter().copied();
            cells.push(part.elements.ids[element], part.elements.properties[element], shape, nodes);
            ranks.push(cut.elements[element] as usize);
        }
    }
    let owners: Vec<usize> = cut.nodes.iter().map(|&rank| rank as usize).collect();
    Dataset {
        point_ids: part.nodes.ids.clone(),
        points: part.nodes.initial.clone(),
        cells,
        point_data: vec![Column::ids("OWNER", &owners)],
        cell_data: vec![Column::ids("RANK", &ranks)],
    }
}
