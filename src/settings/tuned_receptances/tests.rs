//! Which changes by blade shapes count for their choice.

use super::*;

#[test]
fn the_lowest_the_middle_and_the_highest_load_count_in_full_in_whatever_order_they_are_listed() {
    let full = |normal_load_n| ContactCondition::Full { normal_load_n };
    let under = |contact, change| ((0, (3, contact)), change);
    let changes = [
        under(ContactCondition::Stuck, 0.9),
        under(full(10.0), 0.01),
        under(full(20.0), 0.04),
        under(full(30.0), 0.02),
        under(full(40.0), 0.05),
        under(full(50.0), 0.03),
    ];
    let limits = [ContactCondition::Slide, ContactCondition::Stuck];
    for order in [
        [10.0, 20.0, 30.0, 40.0, 50.0],
        [40.0, 10.0, 20.0, 50.0, 30.0],
    ] {
        let conditions = [&limits[..], &order.map(full)].concat();
        let [spread, between] = of_friction(&changes, &conditions);
        assert!((spread - 0.03).abs() < 1e-12, "{spread}");
        assert!((between - 0.05).abs() < 1e-12, "{between}");
    }
}
