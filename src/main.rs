//! The program; everything it does is in `lightvein::cli`.

fn main() -> std::process::ExitCode {
    lightvein::cli::main()
}
