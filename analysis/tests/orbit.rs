use crate::systems::*;
use clebsch_analysis::*;
#[test]
fn probe() {
    let flow = Splitting::leapfrog(henon_heiles());
    for &period in &[6.4, 6.6, 7.0, 7.5] {
        let n = 128;
        for s in [vec![0.3, 0.0, 0.0, 0.1], vec![0.0, 0.3, 0.0, 0.0], vec![0.0, 0.0, 0.3, 0.0],vec![0.1, 0.3, 0.2, 0.0],vec![0.0, 0.3, 0.3, 0.0],vec![0.0, -0.3, 0.3, 0.0],vec![0.0, 0.1, 0.4, 0.1]] {
            match orbit(&flow, &s, period / n as f64, n, &Search::default()) {
                Ok(o) => println!("{period} {:?} it {} size {:.3} res {:.1e} mu {:?} err {:?} defect {:.1e}", o.state, o.iterations, o.size, o.residual, o.floquet.values, o.floquet.errors, o.pairing_defect),
                Err(e) => println!("{period} {s:?} {e}"),
            }
        }
    }
}
