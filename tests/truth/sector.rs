//! A sector with its faces, contact, force and observed point kept, and the rest in fixed-interface modes
//! (Craig and Bampton 1968). The modes are those of one sector with both faces held, not those of a nodal diameter.

use blisk::linalg::SymmetricSparse;
use blisk::model::sector::{Component, SectorModel};
use faer::linalg::solvers::Solve;
use faer::{Mat, Side, c64};

/// Rows of a contact pair: normal, first and second tangent.
pub const DIRECTIONS: usize = 3;

/// A contact pair: the relative motion along each direction as a sum over coordinates, and its share.
pub struct Pair {
    pub rows: [Vec<(usize, f64)>; DIRECTIONS],
    pub weight: f64,
}

/// Matrices of a sector over `[low face, high face, kept points, modes]`.
pub struct Sector {
    /// Sectors of the wheel.
    pub sectors: usize,
    /// Degrees of freedom of a face.
    pub face: usize,
    /// Stiffness, N/m, mass, kg, and share of the blade in the stiffness, N/m.
    pub stiffness: Mat<f64>,
    pub mass: Mat<f64>,
    pub blade: Mat<f64>,
    pub pairs: Vec<Pair>,
    /// Force on sector 0, N.
    pub force: Vec<(usize, c64)>,
    /// Coordinates of the observed node.
    pub observed: Vec<usize>,
}

impl Sector {
    /// Coordinates: two faces, kept points and modes.
    pub fn size(&self) -> usize {
        self.stiffness.nrows()
    }

    /// Rows of relative motion.
    pub fn contact_rows(&self) -> usize {
        DIRECTIONS * self.pairs.len()
    }

    /// `model` with `modes` fixed-interface modes.
    pub fn new(model: &SectorModel, modes: usize) -> Self {
        let n = model.dofs.len();
        let low: Vec<usize> = model.cyclic_pairs.iter().map(|pair| pair.0).collect();
        let high: Vec<usize> = model.cyclic_pairs.iter().map(|pair| pair.1).collect();
        let tip = model.observed[0].node;
        let nodes: Vec<usize> = model
            .contact_pairs
            .iter()
            .flat_map(|pair| [pair.first.node(), pair.second.node()])
            .flatten()
            .chain([tip])
            .collect();
        let forced = |dof: usize| model.force.iter().any(|own| own.0 == dof);
        let is_kept = |&dof: &usize| nodes.contains(&model.dofs[dof].node) || forced(dof);
        let on_face = |dof: &usize| low.contains(dof) || high.contains(dof);
        let points = (0..n).filter(|dof| is_kept(dof) && !on_face(dof));
        let kept: Vec<usize> = low.iter().chain(&high).copied().chain(points).collect();
        let inner: Vec<usize> = (0..n).filter(|dof| !kept.contains(dof)).collect();
        let [stiffness, mass, blade] =
            [&model.stiffness, &model.mass, &model.blade_stiffness].map(dense);
        let part = |of: &Mat<f64>, rows: &[usize], columns: &[usize]| {
            Mat::from_fn(rows.len(), columns.len(), |i, j| of[(rows[i], columns[j])])
        };
        let held = part(&stiffness, &inner, &inner);
        let factor = held
            .llt(Side::Lower)
            .expect("a positive definite stiffness");
        let statics = -factor.solve(part(&stiffness, &inner, &kept));
        let shapes = lowest_modes(&held, &part(&mass, &inner, &inner), modes);
        let size = kept.len() + shapes.ncols();
        let mut basis = Mat::<f64>::zeros(n, size);
        for (column, &dof) in kept.iter().enumerate() {
            basis[(dof, column)] = 1.0;
            for (row, &own) in inner.iter().enumerate() {
                basis[(own, column)] = statics[(row, column)];
            }
        }
        for column in 0..shapes.ncols() {
            for (row, &own) in inner.iter().enumerate() {
                basis[(own, kept.len() + column)] = shapes[(row, column)];
            }
        }
        let reduced = |of: &Mat<f64>| basis.transpose() * (of * &basis);
        let place = |node: usize, component: Component| {
            let dof = model.dof_of(node, component)?;
            Some(kept.iter().position(|&own| own == dof).expect("kept"))
        };
        // The ground does not move, nor does a node along a direction in which it has no dof.
        let along = |node: Option<usize>, direction: [f64; 3], sign: f64| {
            let Some(node) = node else { return Vec::new() };
            [Component::Radial, Component::Tangential, Component::Axial]
                .into_iter()
                .zip(direction)
                .filter(|(_, part)| *part != 0.0)
                .filter_map(|(component, part)| Some((place(node, component)?, sign * part)))
                .collect::<Vec<_>>()
        };
        let pairs = model.contact_pairs.iter().map(|pair| {
            let [t1, t2] = tangents(pair.normal);
            let row = |direction| {
                let mut row = along(pair.first.node(), direction, 1.0);
                row.extend(along(pair.second.node(), direction, -1.0));
                row
            };
            Pair {
                rows: [row(pair.normal), row(t1), row(t2)],
                weight: pair.weight,
            }
        });
        let force = model.force.iter().map(|&(dof, newton)| {
            let at = kept.iter().position(|&own| own == dof).expect("kept");
            (at, c64::new(newton.re, newton.im))
        });
        let tip_dofs = (0..n).filter(|&dof| model.dofs[dof].node == tip);
        Self {
            sectors: model.sectors,
            face: low.len(),
            pairs: pairs.collect(),
            force: force.collect(),
            observed: tip_dofs
                .map(|dof| kept.iter().position(|&own| own == dof).expect("kept"))
                .collect(),
            stiffness: reduced(&stiffness),
            mass: reduced(&mass),
            blade: reduced(&blade),
        }
    }
}

fn dense(sparse: &SymmetricSparse) -> Mat<f64> {
    let n = sparse.dimension();
    let mut full = Mat::zeros(n, n);
    for (row, column, value) in sparse.lower_entries() {
        full[(row, column)] = value;
        full[(column, row)] = value;
    }
    full
}

/// Mass-normalised modes of `K phi = lambda M phi` with the lowest `lambda`.
fn lowest_modes(stiffness: &Mat<f64>, mass: &Mat<f64>, count: usize) -> Mat<f64> {
    let n = stiffness.nrows();
    // M = L L^T; the modes of L^-1 K L^-T, turned back by L^-T.
    let root = mass.llt(Side::Lower).expect("a positive definite mass");
    let lower = root.L().to_owned();
    let forward = |of: &Mat<f64>| {
        let mut solved = of.clone();
        faer::linalg::triangular_solve::solve_lower_triangular_in_place(
            lower.as_ref(),
            solved.as_mut(),
            faer::Par::Seq,
        );
        solved
    };
    let half = forward(stiffness);
    let standard = forward(&half.transpose().to_owned());
    let symmetric = Mat::from_fn(n, n, |i, j| 0.5 * (standard[(i, j)] + standard[(j, i)]));
    let modes = symmetric.self_adjoint_eigen(Side::Lower).expect("modes");
    let mut shapes = modes.U().subcols(0, count.min(n)).to_owned();
    faer::linalg::triangular_solve::solve_upper_triangular_in_place(
        lower.transpose(),
        shapes.as_mut(),
        faer::Par::Seq,
    );
    shapes
}

/// The two tangents of a pair: `e_theta` projected on the plane of contact (`e_z` where the normal is nearly that), and
/// `n x t1`.
fn tangents(normal: [f64; 3]) -> [[f64; 3]; 2] {
    let axis = if normal[1].abs() > 0.9 { 2 } else { 1 };
    let mut first = normal.map(|part| -part * normal[axis]);
    first[axis] += 1.0;
    let length = first.iter().map(|part| part * part).sum::<f64>().sqrt();
    let first = first.map(|part| part / length);
    let [a, b] = [normal, first];
    let second = [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ];
    [first, second]
}
