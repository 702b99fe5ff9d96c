let up=new Float64Array(1);

let ALL=[-1/0,1/0];

let side=(s,c)=>s>0?1:c<0?-1:0;

function out(t,u,a=1){let b=a*Number.EPSILON,n=Number.MIN_VALUE,r=(t-=Math.abs(t)*b+n)<=(u+=Math.abs(u)*b+n);return up[0]=r?u:1/0,r?t:-1/0}

let plus=(o,s,t,u)=>out(o+t,s+u);

function times(t,n,e,o){let u=t*e,c=t*o,i=n*e,r=n*o;let s=u,f=u;return c<s?s=c:c>f&&(f=c),i<s?s=i:i>f&&(f=i),r<s?s=r:r>f&&(f=r),out(s,f)}

function power(t,o,u){let a=Math.abs(u),n=t**a,r=o**a;let e=out(Math.min(n,r),Math.max(n,r),4);if(!(t>=0)&&u%2||(e=t<0&&o>0?0:Math.max(e,0)),u>0)return e;let h=up[0];return e>0||h<0?out(1/h,1/e):0===e?out(1/h,1/0):out(-1/0,1/0)}

let rising=(i,n,o)=>out(i(n),i(o),4);

function cosine(a,t){let h=Math.ceil(a/Math.PI-1e-9),M=Math.floor(t/Math.PI+1e-9),e=M-h<1&&Math.abs(a)+Math.abs(t)<1e6,o=Math.cos(a),s=Math.cos(t),c=e&&h===M&&1-2*Math.abs(h%2);return up[0]=1!==c&&e?Math.max(o,s)+4*Number.EPSILON:1,-1!==c&&e?Math.min(o,s)-4*Number.EPSILON:-1}

function sums(t,r,o){let e=new Float64Array(2*r),n=new Float64Array(2*r),a=new Float64Array(r);let l=0;for(let u=0;u<t.length;u++)if(t[u]){o(u,e);for(let t=0;t<r;t++){let r=e[2*t],o=e[2*t+1];n[2*t]+=r,n[2*t+1]+=o,a[t]+=Math.max(-r,o)}l++}for(let t=0;t<r;t++){let r=l*Number.EPSILON*a[t];n[2*t]=out(n[2*t]-r,n[2*t+1]+r),n[2*t+1]=up[0]}return n}

function isolate(e,s,n,t,u){let i=(n,t)=>{const[u,i,l,o]=e.enclose(s,n,t);if(side(u,i)||side(l,o))return[side(u,i),side(l,o)];let r=(n+t)/2,[c,f]=e.enclose(s,r,r);return[side(plus(c,f,times(l,o,plus(n,t,-r,-r),up[0]),up[0]),up[0]),0]},l=[],o=[],r=(e,s,n)=>n?.[2]||i(e,e)[0]||Math.sign(u[s]);let c=2e3,f=n,p=0;let a=(e,s,n)=>{const[t,u]=i(e,s),o=(e+s)/2;t||u||!n||--c<0?l.push([e,s,t,u]):(a(e,o,n-1),a(o,s,n-1))},d=e.seen[s],h=d?.[0]===n&&d.at(-1)===t?d:[n,t];if(n<t)for(let e=1;e<h.length;e++)a(h[e-1],h[e],48);e.seen[s]??=[n,...l.map(([,e])=>e)];let g=r(n,0,l[0]);for(const[e,s,n,u]of[...l,[t,t,r(t,1,l.at(-1)),0]])if(!n&&u&&p*u>=0)p=u;else{if(!n&&e<s)return[null,e,s];if(e>f?!(g*n):g*n<0)return[null,f,e];g*n<0&&o.push([f,e,n]),[f,g,p]=[s,n,0]}return o}
