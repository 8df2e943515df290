fn main() {
    let text = std::io::read_to_string(std::io::stdin()).unwrap();
    let tokens = vi_codegen::expand(text.parse().unwrap());
    match syn::parse2::<syn::File>(tokens.clone()) {
        Ok(f) => println!("{}", prettyplease::unparse(&f)),
        Err(e) => println!("{e}\n{tokens}"),
    }
}
