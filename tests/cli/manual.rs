//! The manual pages: one of the program and one of every command, with what its help says.

use clap::CommandFactory;

use crate::blisk::Place;

#[test]
fn every_command_has_a_manual_page() {
    let place = Place::new();
    let ended = place.run(&["man", "--out", "man/man1"]);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    let page = |name: &str| {
        let path = place.path(&format!("man/man1/{name}.1"));
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    };
    let program = blisk::cli::Arguments::command();
    let main = page("blisk");
    let shown = |command: &&clap::Command| !command.is_hide_set();
    for command in program.get_subcommands().filter(shown) {
        let name = command.get_name();
        let own = page(&format!("blisk-{name}"));
        assert!(own.starts_with(".ie \\n(.g .ds Aq"), "{name}: {own}");
        assert!(
            own.contains(&format!(".TH blisk-{name} 1")),
            "{name}: {own}"
        );
        // A hyphen is written `\-`.
        assert!(main.contains(&format!("blisk\\-{name}(1)")), "{name}");
        for option in command.get_arguments().filter_map(clap::Arg::get_long) {
            let written = format!("\\-\\-{}", option.replace('-', "\\-"));
            assert!(own.contains(&written), "{name} --{option}: {own}");
        }
    }
    let pages = std::fs::read_dir(place.path("man/man1")).expect("a folder");
    let commands = program.get_subcommands().filter(shown).count();
    assert_eq!(pages.count(), commands + 1);
    // The same program writes the same bytes.
    let before = page("blisk-run");
    assert_eq!(place.run(&["man", "--out", "man/man1"]).code, 0);
    assert_eq!(before, page("blisk-run"));
}
