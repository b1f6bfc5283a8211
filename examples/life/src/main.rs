use linkwear::{life::LifeStudy, mechanism::Mechanism};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A mechanism with wear: a shipped one, or Mechanism::read("my.toml").
    let mechanism = Mechanism::shipped("rssr").ok_or("no such mechanism")?;

    // Everything has a default; set fields to change it: LifeStudy { seed: 7, ..LifeStudy::new(&mechanism) }.
    let life = LifeStudy::new(&mechanism).run()?;
    println!("mean path: {} fails after {:.3} cycles", life.failed_joint().joint, life.end.cycles);

    // Random lives: each statistic with its standard error, in cycles.
    let lives = life.statistics().ok_or("no random lives")?;
    println!("mean, whole cycles  {:.3}", life.mean_whole_cycles());
    for (name, found) in [("mean", lives.mean()), ("standard deviation", lives.std()), ("cov", lives.cov())] {
        println!("{name:<18}  {:.4} +- {:.4}", found.value, found.error);
    }
    for p in [0.1, 0.5, 0.9] {
        println!("B{:<17}  {:.3} +- {:.3}", 100.0 * p, lives.quantile(p)?.value, lives.quantile(p)?.error);
    }
    println!("error of the mean, half-widths at 95 % [cycles]\n{}", life.budget());
    Ok(())
}
